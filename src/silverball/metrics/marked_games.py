"""Whole games by the rules of a table, watched for its marks: times, points, drains, shots, missions.

Games are those of a `GameBatch`, 240 ticks a second. A player decides 60 times a second. What is watched is
noted then too, so times are exact to 1/60 s.

Lengths are [u], times are counted in ticks.
"""

from __future__ import annotations

from collections.abc import Callable
from math import hypot
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.game.game_batch import GameBatch
from silverball.metrics.game_traces import (
    BEGINNER,
    REMEMBERED_TICKS,
    STAY_RADIUS,
    TICK_RATE,
    beginner_presses,
)
from silverball.physics.kernel import internal, kernel
from silverball.physics.records import (
    LAUNCH,
    LEFT,
    RIGHT,
    BatchGeometry,
    BoardRecord,
    Colliders,
    Motion,
    WorldRecord,
    records,
)
from silverball.physics.step import button_bits
from silverball.players.batch_policies import BatchPolicy, batch_policy
from silverball.players.planner import BRANCHES
from silverball.players.simple import PlayerKind, launch_bit, pressed
from silverball.referee.game_records import NOT_RUNNING, Light
from silverball.table import Table
from silverball.table.kinds.rollover import Rollover

STEP = 4  # ticks between two decisions
ABOVE = 0.8  # [u] over the outlanes' switches; a ball that comes up again to there is not lost by an outlane
NEVER_RAN = -1  # of a mode
OUTLANE = "outlane"  # in the name of a switch that only balls on their way out cross

MARK = np.dtype(
    [
        ("ticks", "i8"),  # with a ball in play that moves, or that a hole holds
        ("passes", "i8"), ("drained", "i8"), ("locked", "i8"),  # as they were when last noted
        ("pending", "i8"),  # balls that have crossed an outlane's switch and are not yet lost
        ("by_outlane", "i8"), ("by_centre", "i8"),  # balls lost
        ("at_x", "f8"), ("at_z", "f8"), ("stay", "i8"), ("longest_stay", "i8"),  # of a single ball
    ],
    align=True,
)  # fmt: skip


class MarkedGames(NamedTuple):
    """What was noted of some games under one player.

    Attributes:
        mark: MARK records [game].
        games: The GAME records at the end [game].
        hits: Hits of each part [game, part].
        lamps: Whether each lamp was on at some time, bool [game, lamp].
        modes: The tick in which each mode was first seen to run, [game, mode]; −1 if it never ran.
        counters: The greatest value of each counter [game, counter].
        has_outlanes: Whether switches show that a ball is lost by an outlane.
    """

    mark: NDArray[Any]
    games: NDArray[Any]
    hits: NDArray[np.int64]
    lamps: NDArray[np.bool_]
    modes: NDArray[np.int64]
    counters: NDArray[np.int64]
    has_outlanes: bool

    @property
    def minutes(self) -> NDArray[np.float64]:
        """Minutes in play [game]."""
        found: NDArray[np.float64] = self.mark["ticks"] / (60.0 * TICK_RATE)
        return found


class Notes(NamedTuple):
    """Where it is noted what happens.

    Attributes:
        mark: As in `MarkedGames`.
        lamps: As in `MarkedGames`.
        modes: As in `MarkedGames`.
        counters: As in `MarkedGames`.
        outlanes: The parts that only balls on their way out cross.
        line: The height below which a ball may be on its way out [u].
    """

    mark: Any
    lamps: NDArray[np.bool_]
    modes: NDArray[np.int64]
    counters: NDArray[np.int64]
    outlanes: NDArray[np.int64]
    line: float


def play_marked_games(
    table: Table,
    player: str,
    count: int,
    seed: int = 0,
    longest: float = 600.0,
    branches: int = BRANCHES,
    progress: Callable[[float], None] | None = None,
) -> MarkedGames:
    """Play whole arcade games.

    Args:
        table: The table.
        player: The name of a player, or "beginner".
        count: Games.
        seed: Of the first game; the next one has the next number.
        longest: [s] after which a game is cut short.
        branches: That the planner tries at a decision.
        progress: Called from time to time with the share of the games that are over.
    """
    batch = GameBatch(table, count, seed, TICK_RATE)
    notes = _notes(batch)
    buttons = Buttons(batch, player, branches)
    blocks = round(longest * TICK_RATE / STEP)
    for block in range(blocks):
        batch.step_unchecked(buttons.held(), STEP)
        note_games(batch.state, batch.games, batch.tallies, notes)
        if block % TICK_RATE == 0:
            over = float((batch.games["over"] != 0).mean())
            if progress is not None:
                progress(max(over, block / blocks))
            if over == 1.0:
                break
    return MarkedGames(
        notes.mark,
        batch.games,
        batch.tallies,
        notes.lamps,
        notes.modes,
        notes.counters,
        len(notes.outlanes) > 0,
    )


def _notes(batch: GameBatch) -> Notes:
    table = batch.tables[0]
    lanes = [
        (batch.boards.names[0].index(one.name), one.part)
        for one in table.parts()
        if isinstance(one.part, Rollover) and OUTLANE in one.part.name
    ]
    heights = [max(start[0] for start in (part.start, part.center) if start is not None) for _, part in lanes]
    return Notes(
        records(batch.count, MARK),
        np.zeros((batch.count, len(batch.books.lamps[0])), np.bool_),
        np.full((batch.count, len(batch.books.modes[0])), NEVER_RAN),
        np.zeros((batch.count, len(batch.books.counters[0])), np.int64),
        np.array([number for number, _ in lanes], np.int64),
        max(heights, default=-0.5 * table.board.length) + ABOVE,
    )


class Buttons:
    """What a player holds in all games."""

    def __init__(self, batch: GameBatch, player: str, branches: int) -> None:
        self._batch = batch
        self._held = np.zeros((1, batch.count, 4), np.bool_)
        self._decisions = np.zeros((batch.count, 2, REMEMBERED_TICKS), np.bool_)
        self._policy: BatchPolicy | None = None
        self._kind = BEGINNER
        if player != "beginner":
            self._policy = batch_policy(player, batch, branches)
            self._kind = int(PlayerKind.__members__.get(player.upper(), PlayerKind.DECIDED))

    def held(self) -> NDArray[np.bool_]:
        """The buttons to hold in the next STEP ticks, bool [1, world, 4]."""
        batch = self._batch
        if self._policy is not None:
            self._policy.decide()
            self._held[0, :, :2] = self._policy.buttons
        hold_buttons(self._kind, batch.state, batch.board_of, batch.geometries, self._decisions, self._held)
        return self._held


@kernel
def hold_buttons(
    player: int, worlds: Any, board_of: Any, geometries: BatchGeometry, decisions: Any, held: Any
) -> None:
    """Write what a player, a PlayerKind or BEGINNER, holds in the next ticks: bool [1, world, 4]."""
    for index in range(len(worlds)):
        board, row = geometries.boards[board_of[index]], held[0, index]
        bits = held_bits(player, worlds[index], board, geometries.colliders, decisions[index], row)
        row[0], row[1], row[3] = bits & LEFT != 0, bits & RIGHT != 0, bits & LAUNCH != 0


@internal
def held_bits(
    player: int, world: WorldRecord, board: BoardRecord, colliders: Colliders, decisions: Any, held: Any
) -> int:
    """The bits of the buttons that a player, a PlayerKind or BEGINNER, holds in the next STEP ticks.

    One that has DECIDED holds `held`, bool [2]: left, right.
    """
    tick = 1.0 / TICK_RATE
    left, right = held[0], held[1]
    if player == BEGINNER:
        left, right = beginner_presses(world, board, colliders, decisions, tick)
        now = world.tick % REMEMBERED_TICKS
        for ahead in range(1, STEP):
            slot = (now + ahead) % REMEMBERED_TICKS
            decisions[0, slot], decisions[1, slot] = decisions[0, now], decisions[1, now]
    elif player != PlayerKind.DECIDED:
        left, right = pressed(player, world, board, colliders, tick)
    return button_bits(left, right) | launch_bit(world, board, tick)


@kernel
def note_games(worlds: Any, games: Any, tallies: Any, notes: Notes) -> None:
    """Note what has happened in the last STEP ticks."""
    for index in range(len(worlds)):
        game = games[index]
        for lamp in range(notes.lamps.shape[1]):
            if game.lamp[lamp] == Light.ON:
                notes.lamps[index, lamp] = True
        for mode in range(notes.modes.shape[1]):
            if game.mode_end[mode] != NOT_RUNNING and notes.modes[index, mode] == NEVER_RAN:
                notes.modes[index, mode] = worlds[index].tick
        for counter in range(notes.counters.shape[1]):
            value = game.counter[counter]
            notes.counters[index, counter] = max(value, notes.counters[index, counter])
        note_drains(worlds[index], game, tallies[index], notes, index)
        if game.over == 0:
            note_balls(worlds[index], game, notes.mark[index])


@internal
def note_drains(world: Any, game: Any, tally: Any, notes: Notes, index: int) -> None:
    """Note lost balls, and by which way."""
    mark, passes, is_low = notes.mark[index], 0, False
    for number in range(len(notes.outlanes)):
        passes += tally[notes.outlanes[number]]
    mark.pending += passes - mark.passes
    lost = world.drained - mark.drained - max(game.locked - mark.locked, 0)
    mark.passes, mark.drained, mark.locked = passes, world.drained, game.locked
    by_outlane = min(max(lost, 0), mark.pending)
    mark.by_outlane += by_outlane
    mark.by_centre += max(lost, 0) - by_outlane
    mark.pending -= by_outlane
    for slot in range(len(world.ball)):
        is_low = is_low or (world.ball[slot].id != 0 and world.ball[slot].x < notes.line)
    if not is_low:
        mark.pending = 0


@internal
def note_balls(world: Any, game: Any, mark: Any) -> None:
    """Note the time in play, and how long a single ball stays in one place while no paddle is held up."""
    count, moving = 0, -1
    for slot in range(len(world.ball)):
        if world.ball[slot].id != 0:
            count += 1
            if world.ball[slot].motion != Motion.CAPTURED:
                moving = slot
    if moving < 0:
        mark.stay = 0
        return
    mark.ticks += STEP
    ball = world.ball[moving]
    is_held = game.buttons & (LEFT | RIGHT) != 0
    if count > 1 or is_held or hypot(ball.x - mark.at_x, ball.z - mark.at_z) > STAY_RADIUS:
        mark.at_x, mark.at_z, mark.stay = ball.x, ball.z, 0
    mark.stay += STEP
    mark.longest_stay = max(mark.longest_stay, mark.stay)
