"""The planner: simulates copies of the world and presses what led to the best future.

Sixty times a second the planner copies the world, tries plans on the copies with the same step function that
advances the world, keeps the best plan and presses its first buttons. It improves this plan at every decision
until it has been carried out, so a shot at a ball on its way down has been tried in a thousand ways when the
ball arrives.

It sees only what a copy of the world shows. Nothing random happens in a copy, because no ball is shoved or
created in it. Its work is bounded by a number of branches and moves and not by a clock, so a game it plays
is the same on every machine.

In a game by the rules of a table it also aims: what a hit of each part is worth now (`aims.py`) adds to the
value of the branches that reach it.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.physics.event_log import clear_log
from silverball.physics.kernel import as_int, inlined, internal, kernel
from silverball.physics.records import (
    BOARD,
    LEFT,
    LOG,
    LOG_SIZE,
    RIGHT,
    BatchGeometry,
    BoardGeometry,
    BoardRecord,
    Colliders,
    Lane,
    LogRecord,
    Motion,
    Tally,
    WorldRecord,
    records,
)
from silverball.physics.step import (
    advance,
    are_balls_on_board,
    button_bits,
    can_step,
)
from silverball.players.aims import AimRows, aim_rows, weigh_parts
from silverball.players.plan import (
    PLAN,
    PlanRecord,
    clear_plan,
    draw_plan,
    hold_all,
    is_held,
    next_change,
    vary_plan,
    wants_new_plan,
)
from silverball.players.simple import PlayerKind, is_button_up, pressed
from silverball.referee.judge import is_scoring
from silverball.world import World, WorldBatch

if TYPE_CHECKING:
    from silverball.game.core import GameCore

DECISIONS = 60  # decisions per second
BRANCHES = 60  # branches tried at one decision
MOVES = 10_000  # upper limit for all branches of a decision; a skip over many steps counts as one move
HORIZON = 10.0  # [s] upper limit of a branch: a shot down the middle can take 7 s to come back
LOW_HORIZON = 4.0  # [s] upper limit of its time with a ball in reach of the paddles
RISE = 1.0  # [u] above the reach of the paddles; a branch ends when every ball has risen so far twice
LEAD = 12  # steps before a ball is in reach of the paddles at which branches begin to differ
LOSS_TIME = 2.0  # [s] a ball lost after this time counts half
GAIN = 0.1  # upper limit of the value of points; a ball lost at once costs 1
GAIN_HALF = 5.0  # number of hits of the most valuable part that are worth GAIN / 2
AIM_GAIN = 0.4  # upper limit of the value of lit shots that a branch makes
AIM_TIME = 8.0  # [s] a shot that is made after this time counts half
DRY_FROM = 6.0  # [s] up to this time without points costs nothing
DRY_TO = 14.0  # [s] from this time on it costs as much as a ball lost at once

NEVER_DECIDED = -2  # step of the last decision; a first decision continues no plan

MEMORY = np.dtype(
    [
        ("step", "i8"),  # of the last decision
        ("score", "i8"), ("scored_tick", "i8"),  # the last score seen, and when it changed
        ("branches", "i8"), ("move_limit", "i8"),  # at one decision: branches to try, moves in all of them
        ("tried", "i8"), ("moves", "i8"),  # branches and moves of the last decision
        ("aims", "i8"), ("looks", "i8"),  # whether it aims at anything; branches that it has looked at so far
    ],
    align=True,
)  # fmt: skip
MemoryRecord: TypeAlias = Any  # a MEMORY record

# Rows of a world's plans and copies.
BEST, TRIAL = 0, 1  # the plan that is followed, and the one that is tried
ROOT, BRANCH = 0, 1  # the world where the branches begin, and a branch


class Opening(IntEnum):
    """The plans that are tried first at every decision; later ones are random."""

    FOLLOWED = 0  # the best plan of the decision before
    REFLEX = 1  # the reflex player
    HOLD = 2  # the buttons as they are
    RELEASE = 3  # neither button
    COUNT = 4


class PlannerState(NamedTuple):
    """What the planners of some worlds remember from one decision to the next, and their scratch space.

    Attributes:
        memories: MEMORY records [world].
        plans: PLAN records [world, BEST or TRIAL].
        copies: World records [world, ROOT or BRANCH].
        logs: LOG records [world]; scratch.
        tallies: Hits [world, part]; scratch.
        buttons: The buttons to hold, bool [world, 2]: left, right.
        worths: What a hit of each part is worth in the game of a world, in mean awards, f8 [world, part].
        seen: The last branch in which each part was hit [world, part]; scratch.
    """

    memories: NDArray[Any]
    plans: NDArray[Any]
    copies: NDArray[Any]
    logs: NDArray[Any]
    tallies: NDArray[np.int64]
    buttons: NDArray[np.bool_]
    worths: NDArray[np.float64]
    seen: NDArray[np.int64]

    @classmethod
    def of(cls, worlds: NDArray[Any], parts: int, branches: int = BRANCHES) -> PlannerState:
        """The state of planners that have not decided yet.

        Args:
            worlds: The worlds in which they will play.
            parts: Parts of the largest board.
            branches: Branches to try at a decision.
        """
        count = len(worlds)
        memories = records(count, MEMORY)
        memories["step"] = NEVER_DECIDED
        memories["branches"] = branches
        memories["move_limit"] = MOVES
        return cls(
            memories,
            records(2 * count, PLAN).reshape(count, 2),
            records(2 * count, worlds.dtype).reshape(count, 2),
            records(count, LOG),
            np.zeros((count, parts), np.int64),
            np.zeros((count, 2), np.bool_),
            np.zeros((count, parts)),
            np.zeros((count, parts), np.int64),
        )

    def aim(self, games: NDArray[Any], board_of: NDArray[np.int64], rows: AimRows) -> None:
        """Aim at what is lit in some games, GAME records [world]."""
        weigh_parts(games, board_of, rows, self.worths)
        self.memories["aims"] = self.worths.any(axis=1)


def ticks_per_decision(tick_rate: int) -> int:
    """Ticks between two decisions."""
    return max(1, round(tick_rate / DECISIONS))


class Planner:
    """The planner for a single world.

    It remembers the plan that it follows: another planner that takes over starts without one and may continue
    differently.

    Args:
        branches: Branches to try at a decision, at most; it also ends after MOVES moves. Fewer are faster.

    Attributes:
        state: Its memory and scratch space; made when it first sees a world.
    """

    name = "planner"

    def __init__(self, branches: int = BRANCHES) -> None:
        self._branches = branches
        self._world: World | None = None
        self._game: GameCore | None = None

    def watch(self, game: GameCore) -> None:
        """Aim at what is lit in a game whose world this player will play."""
        self._game = game
        rows = game.rule_rows
        self._aims = None if rows is None else (rows[0], aim_rows(rows[1]))

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick."""
        ticks_per_step, tick = ticks_per_decision(world.tick_rate), world.tick
        if world is not self._world:
            self._begin(world)
        step = int(self.state.memories["step"][0])
        if tick % ticks_per_step == 0 or tick // ticks_per_step != step:
            self._copy[0] = world.records[0]
            if self._game is not None and self._game.world is world and self._aims is not None:
                self.state.aim(self._aims[0], self._board_of, self._aims[1])
            geometries = BatchGeometry(self._board, world.records[2], world.grid)
            plan_worlds(
                self._copy,
                self._board_of,
                geometries,
                self.state,
                0,
                1,
                ticks_per_step,
                1.0 / world.tick_rate,
            )
        left, right = self.state.buttons[0].tolist()
        return left, right

    def _begin(self, world: World) -> None:
        """Begin with a world that has not been seen before."""
        self._world = world
        record, board, colliders = world.records
        self._copy, self._board = records(1, record.dtype), records(1, BOARD)
        self.state = PlannerState.of(self._copy, len(colliders), self._branches)
        self._board[0], self._board_of = board, np.zeros(1, np.int64)


def plan_batch(batch: WorldBatch, state: PlannerState) -> NDArray[np.bool_]:
    """The buttons (left, right) to hold until the next decision in every world, bool [world, 2]."""
    ticks_per_step, tick = ticks_per_decision(batch.tick_rate), 1.0 / batch.tick_rate
    geometries = batch.geometries
    batch.on_threads(
        lambda first, end: plan_worlds(
            batch.state, batch.board_of, geometries, state, first, end, ticks_per_step, tick
        ),
        batch.count * MOVES,
    )
    return state.buttons


@kernel
def plan_worlds(
    worlds: Any, board_of: Any, geometries: BatchGeometry, state: PlannerState,
    first: int, end: int, ticks_per_step: int, tick: float,
) -> None:  # fmt: skip
    """Decide what to press in the worlds first … end − 1 for a step.

    Args:
        worlds: World records [world]; not changed.
        board_of: The board of each world [world].
        geometries: The boards.
        state: Memories and scratch of the planners; its buttons are written.
        first: The first world of the slice.
        end: One past its last world.
        ticks_per_step: Ticks in a step.
        tick: Length of a tick [s].
    """
    for index in range(first, end):
        world, memory = worlds[index], state.memories[index]
        plans, copies = state.plans[index], state.copies[index]
        step = world.tick // ticks_per_step
        if memory.step != step - 1:  # another game, or another moment of it
            clear_plan(plans[BEST], step)
        if memory.step != step - 1 or world.score != memory.score:
            memory.score, memory.scored_tick = world.score, world.tick
        memory.step, memory.tried, memory.moves = step, 0, 0
        left = right = False
        length = tick * ticks_per_step
        log = state.logs[index]
        log.count = LOG_SIZE  # full, so that nothing is written to it
        copies[ROOT] = worlds[index]
        root = copies[ROOT]
        geometry = BoardGeometry(geometries.boards[board_of[index]], geometries.colliders, geometries.grid)
        if present_balls(root, geometry.board) != 0 and can_step(root, geometry, log, length):
            dry = (world.tick - memory.scored_tick) * tick
            scratch = Scratch(
                plans, copies, log, state.tallies[index], memory, state.worths[index], state.seen[index]
            )
            left, right = decide(scratch, geometry, dry, length)
        state.buttons[index, 0], state.buttons[index, 1] = left, right


class Scratch(NamedTuple):
    """The rows of a `PlannerState` that belong to one world; see there."""

    plans: Any
    copies: Any
    log: LogRecord
    tally: Tally
    memory: MemoryRecord
    worths: Any
    seen: Any


@internal
def decide(scratch: Scratch, geometry: BoardGeometry, dry: float, length: float) -> tuple[bool, bool]:
    """Try plans on copies of one world, keep the best one, and return its first buttons.

    `dry` [s] is the time since the last points, `length` [s] that of a step.
    """
    plans, copies, memory, step = scratch.plans, scratch.copies, scratch.memory, scratch.memory.step
    best, trial, root = plans[BEST], plans[TRIAL], copies[ROOT]
    board, colliders = geometry.board, geometry.colliders
    horizon, seed, draws = int(HORIZON / length), root.seed, 0
    left = is_button_up(root, board, colliders, LEFT)
    right = is_button_up(root, board, colliders, RIGHT)
    score = root.score

    # No press can change what happens until a ball is in reach of a paddle.
    hold_all(trial, False, False, step, horizon)
    copies[BRANCH] = copies[ROOT]
    _, arrival = look_ahead(scratch, BRANCH, geometry, step, horizon, length, 0.0, True)
    spare = max(arrival - LEAD, 0)
    look_ahead(scratch, ROOT, geometry, step, spare, length, 0.0, True)
    dry = 0.0 if root.score != score else dry + spare * length
    first = step + spare

    while memory.tried < memory.branches and memory.moves < memory.move_limit:
        plans[TRIAL] = plans[BEST]
        if memory.tried == Opening.REFLEX:
            clear_plan(trial, first)
        elif memory.tried == Opening.HOLD:
            hold_all(trial, left, right, first, horizon)
        elif memory.tried == Opening.RELEASE:
            hold_all(trial, False, False, first, horizon)
        elif memory.tried >= Opening.COUNT and wants_new_plan(seed, step, draws):
            draws = draw_plan(trial, first, seed, step, draws + 1)
        elif memory.tried >= Opening.COUNT:
            draws = vary_plan(trial, first, seed, step, draws + 1)
        copies[BRANCH] = copies[ROOT]
        trial.value, _ = look_ahead(scratch, BRANCH, geometry, first, horizon, length, dry, False)
        if memory.tried == Opening.FOLLOWED or trial.value > best.value:
            plans[BEST] = plans[TRIAL]
        memory.tried += 1
    if spare > 0:
        return False, False
    return buttons_of(best, root, board, colliders, step, length)


@inlined
def buttons_of(
    plan: PlanRecord, world: WorldRecord, board: BoardRecord, colliders: Colliders, step: int, length: float
) -> tuple[bool, bool]:
    """The buttons that a plan holds in a step."""
    if step < plan.until:
        return is_held(plan, 0, step), is_held(plan, 1, step)
    if has_no_ball_in_reach(world, board):
        return False, False
    return pressed(as_int(PlayerKind.REFLEX), world, board, colliders, length)


@inlined
def has_no_ball_in_reach(world: WorldRecord, board: BoardRecord) -> bool:
    """Whether no ball is in reach of a paddle."""
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id != 0 and ball.x <= board.paddle_top and ball.motion != Motion.CAPTURED:
            return False
    return True


@inlined
def balls_below(world: WorldRecord, board: BoardRecord, line: float) -> int:
    """The slots of which the ball is below a line, x [u], as bits; those of empty slots mean nothing."""
    bits = 0
    for slot in range(board.max_balls):
        if world.ball[slot].x < line:
            bits |= 1 << slot
    return bits


@inlined
def present_balls(world: WorldRecord, board: BoardRecord) -> int:
    """The slots with a ball, as bits."""
    bits = 0
    for slot in range(board.max_balls):
        if world.ball[slot].id != 0:
            bits |= 1 << slot
    return bits


@internal
def look_ahead(
    scratch: Scratch, copy: int, geometry: BoardGeometry, first: int, horizon: int, length: float, dry: float,
    is_scout: bool,
) -> tuple[float, int]:  # fmt: skip
    """Play the TRIAL plan on a copy (ROOT or BRANCH) from a step on, for `horizon` steps at most.

    A scout stops when a ball comes in reach of a paddle.

    Returns:
        The value of the plan, and how many steps were played. A ball lost after t seconds counts
        −1/(1 + t/LOSS_TIME), points up to GAIN, lit shots up to AIM_GAIN, a long time without points up to
        −1.
    """
    plan, world, memory = scratch.plans[TRIAL], scratch.copies[copy], scratch.memory
    board, colliders = geometry.board, geometry.colliders
    lane = Lane(world, scratch.log, scratch.tally, scratch.log)
    value, played, scored_at, low, aimed = 0.0, 0, 0, 0, 0.0
    memory.looks += 1
    max_low_steps = int(LOW_HORIZON / length)
    start, score, drained = world.score, world.score, world.drained
    line = board.paddle_top + RISE
    # Slots as bits: with a ball below the line, with one that has risen over it, and again after that.
    below, risen, risen_again = balls_below(world, board, line), 0, 0
    while played < horizon and low < max_low_steps and are_balls_on_board(world, board):
        if not has_no_ball_in_reach(world, board):
            low += 1
            if is_scout:
                break
        now = first + played
        left, right = buttons_of(plan, world, board, colliders, now, length)
        limit = horizon - played
        if now < plan.until:
            limit = min(limit, next_change(plan, now) - now)
        if memory.aims != 0:
            clear_log(scratch.log)
        played += advance(lane, geometry, button_bits(left, right), length, limit)
        memory.moves += 1
        if memory.aims != 0:
            aimed += made_shots(scratch) / (1.0 + played * length / AIM_TIME)
        if world.score != score:
            score, scored_at, dry = world.score, played, 0.0
        if world.drained != drained:
            value -= (world.drained - drained) / (1.0 + played * length / LOSS_TIME)
            drained = world.drained
        now_below = balls_below(world, board, line)
        rises = below & ~now_below
        risen, risen_again, below = risen | rises, risen_again | (risen & rises), now_below
        if present_balls(world, board) & ~risen_again == 0:
            break
    dry += (played - scored_at) * length
    gain = (score - start) / most_points(board, colliders)
    dry_penalty = min(max((dry - DRY_FROM) / (DRY_TO - DRY_FROM), 0.0), 1.0)
    value += GAIN * gain / (gain + GAIN_HALF) + AIM_GAIN * aimed / (aimed + 1.0)
    return value - dry_penalty, played


@internal
def made_shots(scratch: Scratch) -> float:
    """What the parts are worth that were hit in the last move, for the first time in this branch."""
    worth, log = 0.0, scratch.log
    for number in range(log.count):
        event = log.event[number]
        if is_scoring(event.kind) and scratch.seen[event.part] != scratch.memory.looks:
            scratch.seen[event.part] = scratch.memory.looks
            worth += scratch.worths[event.part]
    return worth


@inlined
def most_points(board: BoardRecord, colliders: Colliders) -> float:
    """The points of the most valuable part of a board, at least 1."""
    most = 1
    for index in range(board.collider_first, board.collider_end):
        most = max(most, colliders[index].points)
    return float(most)
