"""How do whole games go: one ball each, from its creation to the gutter, watched in every tick?

A compiled loop plays thousands of them under one player and keeps, beside the world's own counters, what a
world does not know of itself: for how long the ball was fast, lay on a paddle, stayed in one place or made
no points, and where a ball got to that was struck by a paddle.

Lengths are [u], times are counted in ticks of 1/`TICK_RATE` s. Maps have one cell for each quarter of a unit.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.physics.balls import create_ball
from silverball.physics.kernel import internal, kernel
from silverball.physics.paddle import paddle_distance
from silverball.physics.portable_math import uniform
from silverball.physics.records import BoardGeometry, EventKind, Fault, Kind, Lane, Part, records
from silverball.physics.step import step_world
from silverball.players.simple import LOOK_AHEAD, PlayerKind, pressed, strikes
from silverball.world import WorldBatch

TICK_RATE = 240
PADDLES = (int(Part.LEFT_PADDLE), int(Part.RIGHT_PADDLE))
CONTACTS = (int(EventKind.HIT), int(EventKind.TOUCH))  # with a part
LONGEST = 600.0  # [s] at which a game is cut short
CHUNK_TICKS = 1_000_000  # of all worlds together, between two calls of `progress`
CELLS = 4  # of a map, along each unit
GAPS = 200  # bins of the times between two hits, a tenth of a second each, and one for all that is longer
STAY = 0.5  # [u] a ball that gets no further than this from where it was has stayed there
ON_PADDLE = 0.02  # [u] gap below which a ball lies on a paddle or rolls along it; hops are 5e-4 u high
STRUCK = 5.0  # [u/s] up the table, with which a ball leaves a paddle that has struck it
CARRY = 0.2  # [s] for which a paddle may carry a ball: contacts within it are one strike
TOP = 2.0  # [u] below the upper border, where the top of the table begins

# The beginner: sees what the reflex player sees, but answers after a reaction time of his own, and not always
# as fast. Source: reaction to a seen event takes 150 to 250 ms; the jitter is chosen.
BEGINNER = 3  # beside the numbers of `PlayerKind`
BEGINNER_KEY = 0xBE61  # sets his random numbers apart from the world's own
REACTION = (0.15, 0.25)  # [s] least and greatest, drawn once a game
UNSTEADY = 0.03  # [s] by which he may be early or late, drawn anew for every half second
MEMORY = 128  # ticks of wishes that he remembers: more than his slowest reaction

GAME = np.dtype(
    [
        ("over", "i8"),  # 0 goes on, 1 the ball is in the gutter, 2 cut short or no ball
        ("ticks", "i8"), ("fast", "i8"), ("on_paddle", "i8"),  # alive; above half the cap; on a paddle
        ("quiet", "i8"),  # since the last hit
        ("dry", "i8"), ("longest_dry", "i8"),  # without points
        ("at_x", "f8"), ("at_z", "f8"), ("stay", "i8"),  # where it has stayed, and for how long
        ("longest_stay", "i8"), ("longest_x", "f8"), ("longest_z", "f8"),
        # Of the strike that goes on: its age in ticks (0: none), whether it reached the top, a cylinder or
        # anything at all.
        ("struck", "i8"), ("topped", "i8"), ("rung", "i8"), ("met", "i8"),
        ("strikes", "i8"), ("to_top", "i8"), ("to_cylinder", "i8"),
    ],
    align=True,
)  # fmt: skip


class Games(NamedTuple):
    """What came of many games under one player.

    Attributes:
        state: The worlds at their end, WORLD records [game].
        game: GAME records [game].
        heat: Ticks that balls spent in each cell of the board, [x, z].
        stays: The longest stay that began in each cell [ticks], [x, z].
        gaps: How many times between two hits fell into each tenth of a second, [GAPS].
        reached: Of the struck balls, how many met each part before a paddle met them again, [game, part].
    """

    state: NDArray[Any]
    game: NDArray[Any]
    heat: NDArray[np.int64]
    stays: NDArray[np.int64]
    gaps: NDArray[np.int64]
    reached: NDArray[np.int64]


def play_games(
    batch: WorldBatch,
    player: int,
    progress: Callable[[float], None] | None = None,
    longest: float = LONGEST,
) -> Games:
    """Play one ball in each world of a batch, which is as it was afterwards.

    Args:
        batch: Worlds at their beginning, TICK_RATE ticks a second.
        player: A `PlayerKind`, or BEGINNER.
        progress: Called now and then with the share of the games that are over.
        longest: The time at which a game is cut short [s].

    Returns:
        What came of it; the same for the same worlds, on any number of threads.
    """
    if batch.tick_rate != TICK_RATE:
        raise ValueError(f"a feel needs {TICK_RATE} ticks a second, the batch has {batch.tick_rate}")
    count, beginning = batch.count, batch.save()
    game: NDArray[Any] = records(count, GAME)
    wishes = np.zeros((count, 2, MEMORY), np.bool_)
    reached, seen = np.zeros_like(batch.tallies), np.zeros_like(batch.tallies)
    board = batch.tables[0].board
    shape = (int(CELLS * board.length) + 1, int(CELLS * board.width) + 1)
    heat, stays, gaps = np.zeros(shape, np.int64), np.zeros(shape, np.int64), np.zeros(GAPS, np.int64)
    limit = round(longest * TICK_RATE)
    left = np.arange(count)
    while len(left):
        ticks = max(TICK_RATE, CHUNK_TICKS // len(left))
        maps: list[tuple[NDArray[np.int64], ...]] = []
        slice_of = partial(_play_slice, batch, Notes(game, wishes, reached, seen), maps, shape, left)
        batch.on_threads(partial(slice_of, ticks, limit, int(player)), count * ticks)
        for more, longer, others in maps:
            heat, stays, gaps = heat + more, np.maximum(stays, longer), gaps + others
        left = np.nonzero(game["over"] == 0)[0]
        if progress is not None:
            progress(1.0 - len(left) / count)
    end = batch.state.copy()
    batch.restore(beginning)
    return Games(end, game, heat, stays, gaps, reached)


class Notes(NamedTuple):
    """What is written down about each game while it is played; see `play_balls`."""

    game: NDArray[Any]
    wishes: NDArray[np.bool_]
    reached: NDArray[np.int64]
    seen: NDArray[np.int64]


def _play_slice(
    batch: WorldBatch, notes: Notes, maps: list[tuple[NDArray[np.int64], ...]], shape: tuple[int, int],
    left: NDArray[np.int64], ticks: int, limit: int, player: int, first: int, end: int,
) -> None:  # fmt: skip
    """Play a slice of the games that are left, with maps of its own, so that threads do not share any."""
    mine = np.zeros(shape, np.int64), np.zeros(shape, np.int64), np.zeros(GAPS, np.int64)
    chosen = left[first * len(left) // batch.count : end * len(left) // batch.count]
    boards = batch.boards
    play_balls(
        batch.state, boards.board, batch.board_of, boards.collider, boards.grid, boards.place, batch.logs,
        batch.tallies, *notes, *mine, chosen, ticks, limit, 1.0 / TICK_RATE, player,
    )  # fmt: skip
    maps.append(mine)


@kernel
def play_balls(
    worlds: Any, boards: Any, board_of: Any, colliders: Any, grid: Any, places: Any, logs: Any, tallies: Any,
    games: Any, wishes: Any, reached: Any, seen: Any, heat: Any, stays: Any, gaps: Any,
    chosen: Any, ticks: int, limit: int, tick: float, player: int,
) -> None:  # fmt: skip
    """Play the `chosen` worlds on by a number of ticks, or to the end of their games, `limit` ticks at most.

    The first arguments are as in `play_worlds`, the others as in `Games`; `wishes` [world, side, tick] is
    what the beginner remembers, `seen` [world, part] what the ball has met since it was struck.
    """
    for number in range(len(chosen)):
        index = chosen[number]
        world, log, tally, game = worlds[index], logs[index], tallies[index], games[index]
        board = boards[board_of[index]]
        ball = world.ball[0]
        for _ in range(ticks):
            if game.over != 0:
                break
            log.count, log.lost = 0, 0
            if game.ticks == 0:
                create_ball(world, board, colliders, places, log)
                game.at_x, game.at_z = ball.x, ball.z
                log.count = 0
            if player == BEGINNER:
                left, right = beginner_presses(world, board, colliders, wishes[index], tick)
            else:
                left, right = pressed(player, world, board, colliders, tick)
            score = world.score
            step_world(
                Lane(world, log, tally), BoardGeometry(board, colliders, grid), left, right, False, tick
            )
            game.ticks += 1
            follow_hits(game, board, colliders, ball, log, reached[index], seen[index], gaps)
            game.dry = game.dry + 1 if world.score == score else 0
            game.longest_dry = max(game.longest_dry, game.dry)
            if ball.id == 0:
                game.over = 1
            elif game.ticks >= limit or world.fault != Fault.NONE:
                game.over = 2
            else:
                follow_ball(game, world, board, colliders, heat, stays)


@kernel
def beginner_presses(world: Any, board: Any, colliders: Any, wishes: Any, tick: float) -> tuple[bool, bool]:
    """The buttons (left, right) that the beginner holds in the next tick: what he wished a reaction ago.

    He knows that he is slow, and looks ahead by his usual reaction.
    """
    key = world.seed ^ BEGINNER_KEY
    reaction = REACTION[0] + (REACTION[1] - REACTION[0]) * uniform(key, 0 + 0)
    half_second = int(world.tick * tick / 0.5)
    late = UNSTEADY * (2.0 * uniform(key, 1 + half_second) - 1.0)
    now = world.tick % MEMORY
    for side in range(2):
        c = colliders[board.collider_first + Part.LEFT_PADDLE + side]
        wishes[side, now] = strikes(world, board, c, LOOK_AHEAD + reaction)
    then = (world.tick - int((reaction + late) / tick)) % MEMORY
    return wishes[0, then], wishes[1, then]


@internal
def follow_hits(
    game: Any, board: Any, colliders: Any, ball: Any, log: Any, reached: Any, seen: Any, gaps: Any
) -> None:
    """Take down the hits of a tick: how long after the last one, and what a struck ball has met."""
    game.quiet += 1
    if game.struck > 0:
        game.struck += 1
    for number in range(log.count):
        event = log.event[number]
        if event.part < 0 or event.kind not in CONTACTS:
            continue
        if event.part in PADDLES:
            # A paddle that carries a ball meets it again and again: that is one strike.
            goes_on = 0 < game.struck <= int(CARRY * TICK_RATE) and game.met == 0
            if ball.vx > STRUCK:
                game.struck = 1
                if not goes_on:
                    game.strikes += 1
                    game.topped, game.rung, game.met = 0, 0, 0
                    for part in range(len(seen)):
                        seen[part] = 0
            elif not goes_on:
                game.struck = 0
        elif event.kind == EventKind.HIT and game.struck > 0 and seen[event.part] == 0:
            seen[event.part], game.met = 1, 1
            reached[event.part] += 1
            if colliders[board.collider_first + event.part].kind == Kind.CYLINDER and game.rung == 0:
                game.rung = 1
                game.to_cylinder += 1
        if event.kind == EventKind.HIT:
            gaps[min(len(gaps) - 1, int(game.quiet / (0.1 * TICK_RATE)))] += 1
            game.quiet = 0


@internal
def follow_ball(game: Any, world: Any, board: Any, colliders: Any, heat: Any, stays: Any) -> None:
    """Take down where the ball is after a tick, how fast, and for how long it has stayed there."""
    ball = world.ball[0]
    heat[int(CELLS * (ball.x + board.half_length)), int(CELLS * (ball.z + board.half_width))] += 1
    if ball.vx * ball.vx + ball.vz * ball.vz > 0.25 * board.speed_cap * board.speed_cap:
        game.fast += 1
    if ball.x < board.paddle_top:
        for side in range(2):
            c = colliders[board.collider_first + Part.LEFT_PADDLE + side]
            gap, _, _ = paddle_distance(c, world.paddle[side].angle, ball.x, ball.z)
            if gap - board.ball_radius < ON_PADDLE:
                game.on_paddle += 1
                break
    if game.struck > 0 and game.topped == 0 and ball.x > board.half_length - TOP:
        game.topped = 1
        game.to_top += 1
    away_x, away_z = ball.x - game.at_x, ball.z - game.at_z
    if sqrt(away_x * away_x + away_z * away_z) > STAY:
        game.at_x, game.at_z, game.stay = ball.x, ball.z, 0
    game.stay += 1
    row, column = int(CELLS * (game.at_x + board.half_length)), int(CELLS * (game.at_z + board.half_width))
    stays[row, column] = max(stays[row, column], game.stay)
    if game.stay > game.longest_stay:
        game.longest_stay, game.longest_x, game.longest_z = game.stay, game.at_x, game.at_z


def kind_of(name: str) -> int:
    """The number of a player by name; "beginner" is known here only."""
    return BEGINNER if name == "beginner" else int(PlayerKind[name.upper()])
