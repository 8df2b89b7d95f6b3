"""What does the planner press? What led to the best of some futures that it has played ahead.

Sixty times a second the planner copies the world, tries plans on the copies with the very step that moves the
world, keeps the best plan and presses what it says first. It goes on improving this plan beat by beat until
it has been carried out, so that the shot at a ball on its way down has been tried in a thousand ways before
the ball arrives.

It knows no more than a copy of the world tells: nothing random happens in a copy, since nobody shoves in it
and no ball is created. Its work is bounded by a number of branches and of steps and not by a clock, so that a
game it plays is the same on every machine.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import BOARD, LOG, LOG_SIZE, WORLD, Lane, Part, Playfield, records
from silverball.physics.skip_ahead import free_ticks
from silverball.physics.step import end_ticks, is_inside, is_ready, play_tick, turn_paddles
from silverball.players.plan import (
    PLAN,
    clear_plan,
    draw_plan,
    hold_all,
    is_held,
    next_change,
    vary_plan,
    wants_new_plan,
)
from silverball.players.simple import PlayerKind, pressed
from silverball.world import World, WorldBatch

DECISIONS = 60  # a second
BRANCHES = 60  # tried at one decision
STEPS = 10_000  # that all branches of a decision may take together; a leap over many beats counts as one
HORIZON = 10.0  # [s] to which a branch is played at most: a shot may come back after 7 s, down the middle
LOW_HORIZON = 4.0  # [s] of these, with a ball in reach of the paddles
RISES = 2  # a branch ends when every ball has risen from the paddles so often
RISE = 1.0  # [u] above the reach of the paddles to which a ball must rise
LEAD = 12  # beats before a ball is in reach of the paddles at which branches begin to differ
LOSS_TIME = 2.0  # [s] a ball lost so late counts half
GAIN = 0.1  # what points are worth at most, a ball lost at once being 1
GAIN_HALF = 5.0  # hits of the most valuable part that are worth half of that
DRY_FROM, DRY_TO = 6.0, 14.0  # [s] without points: from here on it counts, up to as much as a ball lost

MEMORY = np.dtype(
    [
        ("beat", "i8"),  # of the last decision
        ("score", "i8"), ("scored_tick", "i8"),  # the last score seen, and when it changed
        ("branches", "i8"), ("step_limit", "i8"),  # to try at a decision, and steps to take in all of them
        ("tried", "i8"), ("steps", "i8"),  # branches and steps of the last decision
    ],
    align=True,
)  # fmt: skip


class Notes:
    """What the planners of some worlds keep from one decision to the next, and the room they reckon in.

    Attributes:
        memories: MEMORY records [world].
        plans: PLAN records [2 · world]: the plan that a world's planner follows, and one that is tried.
        copies: WORLD records [2 · world]: where the branches of a world begin, and a branch.
        logs: LOG records [world].
        tallies: Hits [world, part], of no use to anybody.
        buttons: What to press, bool [world, 2]: left, right.
    """

    def __init__(self, count: int, parts: int, branches: int = BRANCHES) -> None:
        self.memories = records(count, MEMORY)
        self.memories["beat"] = -2
        self.memories["branches"] = branches
        self.memories["step_limit"] = STEPS
        self.plans = records(2 * count, PLAN)
        self.copies = records(2 * count, WORLD)
        self.logs = records(count, LOG)
        self.tallies = np.zeros((count, parts), np.int64)
        self.buttons = np.zeros((count, 2), np.bool_)

    @property
    def arrays(self) -> tuple[Any, Any, Any, Any, Any, Any]:
        """All of them, as `plan_worlds` takes them."""
        return self.memories, self.plans, self.copies, self.logs, self.tallies, self.buttons


def beat_of(tick_rate: int) -> int:
    """Ticks between two decisions."""
    return max(1, round(tick_rate / DECISIONS))


class Planner:
    """The planner for a single world.

    It remembers the plan that it follows: another planner put before the same world begins anew, and may play
    it in another way.

    Args:
        branches: Futures to try at a decision, at most; it also ends after STEPS steps. Fewer are faster.
    """

    name = "planner"

    def __init__(self, branches: int = BRANCHES) -> None:
        self._branches = branches
        self._world: World | None = None

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick."""
        every, tick = beat_of(world.tick_rate), world.tick
        if world is not self._world:
            self._meet(world)
        beat = int(self.notes.memories["beat"][0])
        if tick % every == 0 or tick // every != beat:
            self._copy[0] = world.records[0]
            plan_worlds(
                self._copy, self._board, self._board_of, world.records[2], world.grid, *self.notes.arrays,
                0, 1, every, 1.0 / world.tick_rate,
            )  # fmt: skip
        left, right = self.notes.buttons[0].tolist()
        return left, right

    def _meet(self, world: World) -> None:
        """Begin anew with a world."""
        self._world = world
        _, board, colliders = world.records
        self.notes = Notes(1, len(colliders), self._branches)
        self._copy, self._board = records(1, WORLD), records(1, BOARD)
        self._board[0], self._board_of = board, np.zeros(1, np.int64)


def plan_batch(batch: WorldBatch, notes: Notes) -> NDArray[np.bool_]:
    """The buttons (left, right) to hold in the next beat of every world, bool [world, 2]."""
    boards = batch.boards
    batch.on_threads(
        lambda first, end: plan_worlds(
            batch.state, boards.board, batch.board_of, boards.collider, boards.grid, *notes.arrays,
            first, end, beat_of(batch.tick_rate), 1.0 / batch.tick_rate,
        ),
        batch.count * STEPS,
    )  # fmt: skip
    return notes.buttons


@kernel
def plan_worlds(
    worlds: Any, boards: Any, board_of: Any, colliders: Any, grid: Any, memories: Any, plans: Any,
    copies: Any, logs: Any, tallies: Any, buttons: Any, first: int, end: int, every: int, tick: float,
) -> None:  # fmt: skip
    """Decide what to press in the worlds first … end − 1 for a beat.

    Args:
        worlds: WORLD records [world]; not changed.
        boards: BOARD records [board].
        board_of: The board of each world [world].
        colliders: COLLIDER records of all boards.
        grid: The grids of all boards.
        memories: This and what follows, up to `buttons`, are the arrays of `Notes`.
        plans: See `Notes`.
        copies: See `Notes`.
        logs: See `Notes`.
        tallies: See `Notes`.
        buttons: Written.
        first: The first world of the slice.
        end: One past its last world.
        every: Ticks in a beat.
        tick: Length of a tick [s].
    """
    for index in range(first, end):
        world, memory = worlds[index], memories[index]
        beat = world.tick // every
        if memory.beat != beat - 1:  # another game, or another moment of it
            clear_plan(plans[2 * index], beat)
        if memory.beat != beat - 1 or world.score != memory.score:
            memory.score, memory.scored_tick = world.score, world.tick
        memory.beat, memory.tried, memory.steps = beat, 0, 0
        left = right = False
        board, length = boards[board_of[index]], tick * every
        logs[index].count = LOG_SIZE  # full: nothing is written down
        copies[2 * index] = worlds[index]
        root = copies[2 * index]
        if (root.ball[0].id != 0 or root.ball[1].id != 0) and is_ready(
            root, Playfield(board, colliders, grid), logs[index], length
        ):
            dry = (world.tick - memory.scored_tick) * tick
            left, right = decide(
                plans, copies, index, board, colliders, grid, logs[index], tallies[index], memory, beat,
                dry, length,
            )  # fmt: skip
        buttons[index, 0], buttons[index, 1] = left, right


@internal
def decide(
    plans: Any, copies: Any, index: int, board: Any, colliders: Any, grid: Any, log: Any, tally: Any,
    memory: Any, beat: int, dry: float, length: float,
) -> tuple[bool, bool]:  # fmt: skip
    """Try plans on copies of one world, keep the best one, and return its first buttons.

    `dry` [s] is the time since the last points, `length` [s] that of a beat.
    """
    best, trial = plans[2 * index], plans[2 * index + 1]
    root, branch = copies[2 * index], copies[2 * index + 1]
    horizon, seed, draws = int(HORIZON / length), root.seed, 0
    left = root.paddle[0].angle_commanded == colliders[board.collider_first + Part.LEFT_PADDLE].angle_up
    right = root.paddle[1].angle_commanded == colliders[board.collider_first + Part.RIGHT_PADDLE].angle_up
    score = root.score

    # Nobody can change what happens until a ball is in reach of a paddle.
    hold_all(trial, False, False, beat, horizon)
    copies[2 * index + 1] = copies[2 * index]
    _, arrival = look_ahead(
        branch, board, colliders, grid, log, tally, trial, memory, beat, horizon, length, 0.0, True
    )
    spare = max(arrival - LEAD, 0)
    look_ahead(root, board, colliders, grid, log, tally, trial, memory, beat, spare, length, 0.0, True)
    dry = 0.0 if root.score != score else dry + spare * length
    first = beat + spare

    while memory.tried < memory.branches and memory.steps < memory.step_limit:
        plans[2 * index + 1] = plans[2 * index]
        if memory.tried == 1:
            clear_plan(trial, first)  # the reflex player
        elif memory.tried == 2:
            hold_all(trial, left, right, first, horizon)
        elif memory.tried == 3:
            hold_all(trial, False, False, first, horizon)
        elif memory.tried > 3 and wants_new_plan(seed, beat, draws):
            draws = draw_plan(trial, first, seed, beat, draws + 1)
        elif memory.tried > 3:
            draws = vary_plan(trial, first, seed, beat, draws + 1)
        copies[2 * index + 1] = copies[2 * index]
        trial.value, _ = look_ahead(
            branch, board, colliders, grid, log, tally, trial, memory, first, horizon, length, dry, False
        )
        if memory.tried == 0 or trial.value > best.value:
            plans[2 * index] = plans[2 * index + 1]
        memory.tried += 1
    if spare > 0:
        return False, False
    return buttons_of(best, root, board, colliders, beat, length)


@inlined
def buttons_of(
    plan: Any, world: Any, board: Any, colliders: Any, beat: int, length: float
) -> tuple[bool, bool]:
    """What a plan presses in a beat."""
    if beat < plan.until:
        return is_held(plan, 0, beat), is_held(plan, 1, beat)
    if is_above(world, board):
        return False, False
    return pressed(PlayerKind.REFLEX + 0, world, board, colliders, length)


@inlined
def is_above(world: Any, board: Any) -> bool:
    """Whether no ball is in reach of a paddle."""
    a, b = world.ball[0], world.ball[1]
    return not (a.id != 0 and a.x <= board.paddle_top) and not (b.id != 0 and b.x <= board.paddle_top)


@internal
def look_ahead(
    world: Any, board: Any, colliders: Any, grid: Any, log: Any, tally: Any, plan: Any, memory: Any,
    beat: int, horizon: int, length: float, dry: float, scouts: bool,
) -> tuple[float, int]:  # fmt: skip
    """Carry a plan out on a copy of the world from a beat on, for `horizon` beats at most.

    A scout stops when a ball comes in reach of a paddle.

    Returns:
        What the plan is worth, and how many beats were played. A ball lost after t seconds counts
        −1/(1 + t/LOSS_TIME), points up to GAIN, a long time without points up to −1.
    """
    value, step, scored_at, low = 0.0, 0, 0, 0
    lowest = int(LOW_HORIZON / length)
    start, score, drained = world.score, world.score, world.drained
    line = board.paddle_top + RISE
    a, b = world.ball[0], world.ball[1]
    low_a, low_b, rises_a, rises_b = a.x < line, b.x < line, 0, 0
    while step < horizon and low < lowest and is_inside(world, board):
        if not is_above(world, board):
            low += 1
            if scouts:
                break
        now = beat + step
        left, right = buttons_of(plan, world, board, colliders, now, length)
        most = horizon - step
        if now < plan.until:
            most = min(most, next_change(plan, now) - now)
        free = free_ticks(Playfield(board, colliders, grid), a, b, length, most)
        if free == 0:
            play_tick(Lane(world, log, tally), Playfield(board, colliders, grid), left, right, length)
            step += 1
        else:
            for _ in range(free):
                turn_paddles(world, board, colliders, left, right, length)
            end_ticks(world, board, length, free)
            step += free
        memory.steps += 1
        if world.score != score:
            score, scored_at, dry = world.score, step, 0.0
        if world.drained != drained:
            value -= (world.drained - drained) / (1.0 + step * length / LOSS_TIME)
            drained = world.drained
        rises_a += 1 if low_a and a.x > line else 0
        rises_b += 1 if low_b and b.x > line else 0
        low_a, low_b = a.x < line, b.x < line
        if (a.id == 0 or rises_a >= RISES) and (b.id == 0 or rises_b >= RISES):
            break
    dry += (step - scored_at) * length
    gain = (score - start) / most_points(board, colliders)
    share = min(max((dry - DRY_FROM) / (DRY_TO - DRY_FROM), 0.0), 1.0)
    return value + GAIN * gain / (gain + GAIN_HALF) - share, step


@inlined
def most_points(board: Any, colliders: Any) -> float:
    """The points of the most valuable part of a board, at least 1."""
    most = 1
    for index in range(board.collider_first, board.collider_end):
        most = max(most, colliders[index].points)
    return float(most)
