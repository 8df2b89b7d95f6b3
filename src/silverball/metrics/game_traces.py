"""Traces of whole games: one ball each, followed in every tick from its creation to the gutter.

A compiled loop plays thousands of them under one player. Besides the world's own counters it records how long
the ball was fast, lay on a paddle, stayed in one place or scored no points, and what a ball reached after a
paddle had struck it.

Lengths are [u], times are counted in ticks of 1/`TICK_RATE` s. Maps have one cell for each quarter of a unit.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from functools import partial
from math import sqrt
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.physics.balls import create_ball
from silverball.physics.event_log import clear_log
from silverball.physics.kernel import as_int, inlined, internal, kernel
from silverball.physics.paddle import paddle_distance
from silverball.physics.portable_math import uniform
from silverball.physics.records import (
    LEFT,
    RIGHT,
    BatchGeometry,
    BoardGeometry,
    BoardRecord,
    Colliders,
    EventKind,
    Fault,
    Lane,
    Lanes,
    Part,
    Places,
    WorldRecord,
    records,
)
from silverball.physics.step import button_bits, step_world
from silverball.players.simple import LOOK_AHEAD, PlayerKind, launch_bit, pressed, struck_buttons
from silverball.world import WorldBatch

TICK_RATE = 240
CONTACTS = (int(EventKind.HIT), int(EventKind.TOUCH))  # with a part
MAX_SECONDS = 600.0  # [s] a longer game is cut short
CHUNK_TICKS = 1_000_000  # ticks of all worlds together between two calls of `progress`
CELLS = 4  # cells of a map per unit of length
INTERVAL_BINS = (
    200  # bins of the times between two hits, a tenth of a second each; the last one holds all longer ones
)
STAY_RADIUS = 0.5  # [u] a ball within this distance of a place has stayed there
ON_PADDLE = 0.02  # [u] gap below which a ball lies on a paddle or rolls along it; hops are 5e-4 u high
MIN_STRIKE_SPEED = 5.0  # [u/s] minimum upward speed after a paddle contact for it to count as a strike
MAX_CARRY_TIME = 0.2  # [s] for which a paddle may carry a ball: contacts within it are one strike
TOP_ZONE = 2.0  # [u] below the upper border, where the top of the table begins

# The beginner decides like the reflex player, but presses after a reaction time that varies a little.
# Source: the reaction to a seen event takes 150 to 250 ms; the jitter is chosen.
BEGINNER = 3  # not a `PlayerKind`, so its number differs from all of theirs
BEGINNER_KEY = 0xBE61  # makes its random numbers independent of the world's
REACTION = (0.15, 0.25)  # [s] minimum and maximum; one value is drawn per game
REACTION_JITTER = 0.03  # [s] greatest deviation of its reaction time, drawn for every half second
REMEMBERED_TICKS = 128  # ticks of remembered decisions: more than its slowest reaction


class GameEnd(IntEnum):
    """How a game has ended, if it has."""

    RUNNING = 0
    DRAINED = 1  # the ball is in the gutter
    CUT_SHORT = 2  # by the time limit, or there is no ball


GAME = np.dtype(
    [
        ("over", "i8"),  # GameEnd
        ("ticks", "i8"), ("fast", "i8"), ("on_paddle", "i8"),  # alive; of these fast (> cap / 2), on a paddle
        ("quiet", "i8"),  # since the last hit
        ("dry", "i8"), ("longest_dry", "i8"),  # without points
        ("at_x", "f8"), ("at_z", "f8"), ("stay", "i8"),  # where it has stayed, and for how long
        ("longest_stay", "i8"), ("longest_x", "f8"), ("longest_z", "f8"),
        # Of the current strike: its age in ticks (0: none), whether it reached the top, a cylinder or
        # anything.
        ("struck", "i8"), ("reached_top", "i8"), ("reached_cylinder", "i8"), ("reached_any", "i8"),
        ("strikes", "i8"), ("to_top", "i8"), ("to_cylinder", "i8"),
    ],
    align=True,
)  # fmt: skip
GameRecord: TypeAlias = Any  # a GAME record


class Games(NamedTuple):
    """The traces of many games under one player.

    Attributes:
        state: The worlds at their end, world records [game].
        hits: Hits of each part, [game, part].
        game: GAME records [game].
        heat: Ticks that balls spent in each cell of the board, [x, z].
        stays: The longest stay that began in each cell [ticks], [x, z].
        gaps: How many times between two hits fell into each tenth of a second, [INTERVAL_BINS].
        reached: Of the struck balls, how many met each part before a paddle met them again, [game, part].
    """

    state: NDArray[Any]
    hits: NDArray[np.int64]
    game: NDArray[Any]
    heat: NDArray[np.int64]
    stays: NDArray[np.int64]
    gaps: NDArray[np.int64]
    reached: NDArray[np.int64]


class Traces(NamedTuple):
    """What is recorded about each game while it is played.

    Attributes:
        game: GAME records [game].
        decisions: What the beginner decided in the last ticks, bool [game, side, tick].
        reached: As in `Games`.
        seen: Whether the ball has met each part since it was struck, [game, part].
    """

    game: NDArray[Any]
    decisions: NDArray[np.bool_]
    reached: NDArray[np.int64]
    seen: NDArray[np.int64]


class Maps(NamedTuple):
    """Sums over games; see `Games`."""

    heat: NDArray[np.int64]
    stays: NDArray[np.int64]
    gaps: NDArray[np.int64]


class Setup(NamedTuple):
    """How games are played.

    Attributes:
        player: A `PlayerKind`, or BEGINNER.
        limit: Ticks after which a game is cut short.
        places: The squares of all boards in which balls are created.
        is_cylinder: Whether each part of each board is a cylinder, bool [board, part].
    """

    player: int
    limit: int
    places: Places
    is_cylinder: NDArray[np.bool_]


def play_games(
    batch: WorldBatch,
    player: str,
    progress: Callable[[float], None] | None = None,
    longest: float = MAX_SECONDS,
) -> Games:
    """Play one ball in each world of a batch; the batch is restored afterwards.

    Args:
        batch: Worlds at their beginning, TICK_RATE ticks per second.
        player: The name of a simple player, or "beginner".
        progress: Called from time to time with the share of the games that are over.
        longest: The time after which a game is cut short [s].

    Returns:
        The traces; the same for the same worlds, on any number of threads.

    Raises:
        ValueError: The batch has another tick rate.
    """
    if batch.tick_rate != TICK_RATE:
        raise ValueError(f"games are traced at {TICK_RATE} ticks per second, the batch has {batch.tick_rate}")
    count, beginning, tallies = batch.count, batch.save(), batch.tallies.copy()
    batch.tallies[:] = 0
    kind = BEGINNER if player == "beginner" else int(PlayerKind[player.upper()])
    setup = Setup(kind, round(longest * TICK_RATE), batch.boards.place, parts_of_kind(batch, "cylinder"))
    reached, seen = np.zeros_like(batch.tallies), np.zeros_like(batch.tallies)
    traces = Traces(records(count, GAME), np.zeros((count, 2, REMEMBERED_TICKS), np.bool_), reached, seen)
    board = batch.tables[0].board
    shape = (int(CELLS * board.length) + 1, int(CELLS * board.width) + 1)
    heat, stays, gaps = _empty_maps(shape)
    unfinished = np.arange(count)
    while len(unfinished):
        ticks = max(TICK_RATE, CHUNK_TICKS // len(unfinished))
        parts: list[Maps] = []
        slice_of = partial(_play_slice, batch, traces, setup, parts, shape, unfinished, ticks)
        batch.on_threads(slice_of, count * ticks)
        for part in parts:
            heat, stays, gaps = heat + part.heat, np.maximum(stays, part.stays), gaps + part.gaps
        unfinished = np.nonzero(traces.game["over"] == GameEnd.RUNNING)[0]
        if progress is not None:
            progress(1.0 - len(unfinished) / count)
    end, hits = batch.state.copy(), batch.tallies.copy()
    batch.restore(beginning)
    batch.tallies[:] = tallies
    return Games(end, hits, traces.game, heat, stays, gaps, reached)


def parts_of_kind(batch: WorldBatch, kind: str) -> NDArray[np.bool_]:
    """Whether each part of each board of a batch is of a kind, by its name: bool [board, part]."""
    found = np.zeros((len(batch.boards.names), batch.tallies.shape[1]), np.bool_)
    for row, names in zip(found, batch.boards.names, strict=True):
        row[: len(names)] = [name.startswith(f"{kind}[") for name in names]
    return found


def _empty_maps(shape: tuple[int, int]) -> Maps:
    return Maps(np.zeros(shape, np.int64), np.zeros(shape, np.int64), np.zeros(INTERVAL_BINS, np.int64))


def _play_slice(
    batch: WorldBatch, traces: Traces, setup: Setup, parts: list[Maps], shape: tuple[int, int],
    unfinished: NDArray[np.int64], ticks: int, first: int, end: int,
) -> None:  # fmt: skip
    """Play a slice of the unfinished games into separate maps, so that threads share none."""
    maps = _empty_maps(shape)
    count = len(unfinished)
    chosen = unfinished[first * count // batch.count : end * count // batch.count]
    play_balls(batch.lanes, batch.geometries, traces, maps, setup, chosen, ticks)
    parts.append(maps)


@kernel
def play_balls(
    lanes: Lanes, geometries: BatchGeometry, traces: Traces, maps: Maps, setup: Setup, chosen: Any, ticks: int
) -> None:
    """Advance the `chosen` worlds by a number of ticks, or to the end of their games."""
    colliders, tick = geometries.colliders, 1.0 / TICK_RATE
    for number in range(len(chosen)):
        index = chosen[number]
        world, log, game = lanes.worlds[index], lanes.logs[index], traces.game[index]
        board = geometries.boards[lanes.board_of[index]]
        lane = Lane(world, log, lanes.tallies[index], log)
        geometry = BoardGeometry(board, colliders, geometries.grid)
        ball = world.ball[0]
        for _ in range(ticks):
            if game.over != GameEnd.RUNNING:
                break
            clear_log(log)
            if game.ticks == 0:
                create_ball(world, board, colliders, setup.places, log)
                game.at_x, game.at_z = ball.x, ball.z
                clear_log(log)
            if setup.player == BEGINNER:
                left, right = beginner_presses(world, board, colliders, traces.decisions[index], tick)
            else:
                left, right = pressed(setup.player, world, board, colliders, tick)
            score = world.score
            step_world(lane, geometry, button_bits(left, right) | launch_bit(world, board, tick), tick)
            game.ticks += 1
            is_cylinder = setup.is_cylinder[lanes.board_of[index]]
            follow_hits(
                lane, geometry, game, traces.reached[index], traces.seen[index], maps.gaps, is_cylinder
            )
            game.dry = game.dry + 1 if world.score == score else 0
            game.longest_dry = max(game.longest_dry, game.dry)
            if ball.id == 0:
                game.over = as_int(GameEnd.DRAINED)
            elif game.ticks >= setup.limit or world.fault != Fault.NONE:
                game.over = as_int(GameEnd.CUT_SHORT)
            else:
                follow_ball(game, world, board, colliders, maps)


@kernel
def beginner_presses(
    world: WorldRecord, board: BoardRecord, colliders: Colliders, decisions: Any, tick: float
) -> tuple[bool, bool]:
    """The buttons (left, right) that the beginner holds in the next tick, decided one reaction time ago.

    To compensate for its delay it predicts the ball by its usual reaction time.
    """
    key = world.seed ^ BEGINNER_KEY
    reaction = REACTION[0] + (REACTION[1] - REACTION[0]) * uniform(key, as_int(0))
    half_second = int(world.tick * tick / 0.5)
    late = REACTION_JITTER * (2.0 * uniform(key, 1 + half_second) - 1.0)
    now = world.tick % REMEMBERED_TICKS
    bits = struck_buttons(world, board, colliders, LOOK_AHEAD + reaction)
    decisions[0, now], decisions[1, now] = bits & LEFT != 0, bits & RIGHT != 0
    then = (world.tick - int((reaction + late) / tick)) % REMEMBERED_TICKS
    return decisions[0, then], decisions[1, then]


@inlined
def is_paddle(board: BoardRecord, part: int) -> bool:
    """Whether the part with this number is a paddle."""
    return bool(Part.FIRST_PADDLE <= part < Part.FIRST_PADDLE + board.paddles)


@internal
def follow_hits(
    lane: Lane, geometry: BoardGeometry, game: GameRecord, reached: Any, seen: Any, gaps: Any,
    is_cylinder: Any,
) -> None:  # fmt: skip
    """Record the hits of a tick: how long after the last one, and what a struck ball has met."""
    ball, log = lane.world.ball[0], lane.log
    game.quiet += 1
    if game.struck > 0:
        game.struck += 1
    for number in range(log.count):
        event = log.event[number]
        if event.part < 0 or event.kind not in CONTACTS:
            continue
        if is_paddle(geometry.board, event.part):
            # A paddle that carries a ball meets it again and again: that is one strike.
            is_same_strike = 0 < game.struck <= int(MAX_CARRY_TIME * TICK_RATE) and game.reached_any == 0
            if ball.vx > MIN_STRIKE_SPEED:
                game.struck = 1
                if not is_same_strike:
                    game.strikes += 1
                    game.reached_top, game.reached_cylinder, game.reached_any = 0, 0, 0
                    for part in range(len(seen)):
                        seen[part] = 0
            elif not is_same_strike:
                game.struck = 0
        elif event.kind == EventKind.HIT and game.struck > 0 and seen[event.part] == 0:
            seen[event.part], game.reached_any = 1, 1
            reached[event.part] += 1
            if is_cylinder[event.part] and game.reached_cylinder == 0:
                game.reached_cylinder = 1
                game.to_cylinder += 1
        if event.kind == EventKind.HIT:
            gaps[min(len(gaps) - 1, int(game.quiet / (0.1 * TICK_RATE)))] += 1
            game.quiet = 0


@internal
def follow_ball(
    game: GameRecord, world: WorldRecord, board: BoardRecord, colliders: Colliders, maps: Maps
) -> None:
    """Record where the ball is after a tick, how fast, and for how long it has stayed there."""
    ball = world.ball[0]
    maps.heat[int(CELLS * (ball.x + board.half_length)), int(CELLS * (ball.z + board.half_width))] += 1
    if ball.vx * ball.vx + ball.vz * ball.vz > 0.25 * board.speed_cap * board.speed_cap:
        game.fast += 1
    if ball.x < board.paddle_top:
        for number in range(board.paddles):
            c = colliders[board.collider_first + Part.FIRST_PADDLE + number]
            gap, _, _ = paddle_distance(c, world.paddle[number].angle, ball.x, ball.z)
            if gap - board.ball_radius < ON_PADDLE:
                game.on_paddle += 1
                break
    if game.struck > 0 and game.reached_top == 0 and ball.x > board.half_length - TOP_ZONE:
        game.reached_top = 1
        game.to_top += 1
    away_x, away_z = ball.x - game.at_x, ball.z - game.at_z
    if sqrt(away_x * away_x + away_z * away_z) > STAY_RADIUS:
        game.at_x, game.at_z, game.stay = ball.x, ball.z, 0
    game.stay += 1
    row, column = int(CELLS * (game.at_x + board.half_length)), int(CELLS * (game.at_z + board.half_width))
    maps.stays[row, column] = max(maps.stays[row, column], game.stay)
    if game.stay > game.longest_stay:
        game.longest_stay, game.longest_x, game.longest_z = game.stay, game.at_x, game.at_z
