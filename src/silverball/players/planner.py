"""What does the planner press? What led to the best of some futures that it has played ahead.

Sixty times a second the planner copies the world, tries plans on the copies with the very step that moves the
world, keeps the best plan and presses what it says first. A plan is thought through at every beat until it is
carried out, so that a ball on its way down has been shot in a thousand ways before it arrives.

It knows no more than a copy of the world tells: no draw of the random generator is used in a copy, since
nobody shoves there and no ball is created. Its work is bounded by a number of branches and of steps, not by a
clock, so that a game that it plays is the same on every machine.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.layout import LOG, LOG_SIZE, WORLD, Part, records
from silverball.physics.step import (
    end_ticks,
    free_ticks,
    is_inside,
    is_ready,
    play_tick,
    turn_paddles,
)
from silverball.players.plan import (
    PLAN,
    clear_plan,
    draw,
    draw_plan,
    hold_all,
    is_held,
    next_change,
    vary_plan,
)
from silverball.players.press import PlayerKind, pressed
from silverball.world import World

DECISIONS = 60  # a second
BRANCHES = 60  # tried at one decision, at most
STEPS = 6000  # that all branches of a decision may take together; a leap over many ticks counts as one
HORIZON = 5.0  # [s] to which a branch is played at most
RISES = 2  # a branch ends when every ball has risen from the paddles so often
RISE = 1.0  # [u] above the reach of the paddles to which a ball must rise
LEAD = 12  # beats before a ball is in reach of the paddles at which branches begin to differ
FRESH = 0.3  # of the branches try something new, the others vary the best plan
LOSS_TIME = 2.0  # [s] a ball lost so late counts half
GAIN = 0.1  # what points are worth at most, a ball lost at once being 1
GAIN_HALF = 5.0  # hits of the most valuable part that are worth half of that
DRY_FROM, DRY_TO = 6.0, 14.0  # [s] without points: from here on it counts, up to as much as a ball lost

MEMORY = np.dtype(
    [
        ("beat", "i8"),  # of the last decision
        ("score", "i8"), ("scored_tick", "i8"),  # the last score seen, and when it changed
        ("branches", "i8"), ("steps", "i8"),  # of the last decision
    ],
    align=True,
)  # fmt: skip


class Notes:
    """What planners of several worlds keep from one decision to the next, and the room they reckon in.

    Attributes:
        memory: MEMORY records [world].
        plans: PLAN records [2 · world]: the best plan of a world, and the one that is being tried.
        worlds: WORLD records [2 · world]: where the branches of a world begin, and the branch.
        logs: LOG records [world].
        tallies: Hits [world, part], of no use to anybody.
    """

    def __init__(self, count: int, parts: int) -> None:
        self.memory = records(count, MEMORY)
        self.memory["beat"] = -2
        self.plans = records(2 * count, PLAN)
        self.worlds = records(2 * count, WORLD)
        self.logs = records(count, LOG)
        self.tallies = np.zeros((count, parts), np.int64)

    @property
    def arrays(self) -> tuple[Any, ...]:
        """All five, as kernels take them."""
        return self.memory, self.plans, self.worlds, self.logs, self.tallies


@kernel
def planned(
    world: Any, board: Any, colliders: Any, grid: Any, index: int, memories: Any, plans: Any, worlds: Any,
    logs: Any, tallies: Any, tick: float,
) -> tuple[bool, bool]:  # fmt: skip
    """The buttons (left, right) that the planner holds in the world's next tick; the last five are `Notes`."""
    every = max(1, int(1.0 / (tick * DECISIONS) + 0.5))
    memory = memories[index]
    note_score(world, memory)
    beat = world.tick // every
    if world.tick % every != 0 and memory.beat == beat:
        first = colliders[board.collider_first + Part.LEFT_PADDLE]
        second = colliders[board.collider_first + Part.RIGHT_PADDLE]
        return (
            world.paddle[0].angle_commanded == first.angle_up,
            world.paddle[1].angle_commanded == second.angle_up,
        )
    return decide(
        world, board, colliders, grid, index, memory, plans, worlds, logs[index], tallies[index],
        beat, tick * every, tick,
    )  # fmt: skip


@inlined
def note_score(world: Any, memory: Any) -> None:
    """Note when the score changed."""
    if memory.beat < 0 or world.score != memory.score:
        memory.score, memory.scored_tick = world.score, world.tick


@internal
def decide(
    world: Any, board: Any, colliders: Any, grid: Any, index: int, memory: Any, plans: Any, worlds: Any,
    log: Any, tally: Any, beat: int, length: float, tick: float,
) -> tuple[bool, bool]:  # fmt: skip
    """Try plans on copies of the world, keep the best, and return its first buttons.

    `length` is that of a beat [s], in which copies move, `tick` that of the world.
    """
    best, trial = plans[2 * index], plans[2 * index + 1]
    root, branch = 2 * index, 2 * index + 1
    if memory.beat != beat - 1:
        clear_plan(best, beat)
    memory.beat, memory.branches, memory.steps = beat, 0, 0
    if world.ball[0].id == 0 and world.ball[1].id == 0:
        return False, False
    worlds[root] = world
    log.count = LOG_SIZE
    if not is_ready(worlds[root], board, length):
        return False, False
    worlds[branch] = worlds[root]
    horizon = int(HORIZON / length)
    free = free_beats(
        worlds[root], worlds[branch], board, colliders, grid, log, tally, length, horizon, memory
    )
    earliest = beat + free
    dry = (world.tick - memory.scored_tick) * tick
    if worlds[root].score != world.score:
        dry = 0.0
    seed, count = world.seed, 0
    left = world.paddle[0].angle_commanded == colliders[board.collider_first + Part.LEFT_PADDLE].angle_up
    right = world.paddle[1].angle_commanded == colliders[board.collider_first + Part.RIGHT_PADDLE].angle_up
    while memory.branches < BRANCHES and memory.steps < STEPS:
        number = memory.branches
        if number == 0:
            plans[2 * index + 1] = plans[2 * index]
        elif number == 1:
            clear_plan(trial, earliest)
        elif number == 2:
            hold_all(trial, False, False, earliest, horizon)
        elif number == 3:
            hold_all(trial, left, right, earliest, horizon)
        elif draw(seed, beat, count, 1000) < 1000 * FRESH:
            count = draw_plan(trial, earliest, seed, beat, count + 1)
        else:
            plans[2 * index + 1] = plans[2 * index]
            count = vary_plan(trial, earliest, seed, beat, count + 1)
        worlds[branch] = worlds[root]
        trial.value = look_ahead(
            worlds[branch], board, colliders, grid, log, tally, trial, memory, earliest, horizon, length, dry
        )
        if number == 0 or trial.value > best.value:
            plans[2 * index] = plans[2 * index + 1]
        memory.branches += 1
    if free > 0:
        return False, False
    return buttons(best, worlds[root], board, colliders, beat, length)


@internal
def buttons(
    plan: Any, world: Any, board: Any, colliders: Any, beat: int, length: float
) -> tuple[bool, bool]:
    """What a plan presses in a beat."""
    if beat < plan.until:
        return is_held(plan, 0, beat), is_held(plan, 1, beat)
    if is_above(world, board):
        return False, False
    return pressed(PlayerKind.REFLEX + 0, world, board, colliders, length)


@internal
def move(
    world: Any, board: Any, colliders: Any, grid: Any, log: Any, tally: Any,
    left: bool, right: bool, length: float, most: int,
) -> int:  # fmt: skip
    """Move a copy on with these buttons held, by one beat or as many as nothing happens in; by how many."""
    free = free_ticks(board, colliders, grid, world.ball[0], world.ball[1], length, most)
    if free == 0:
        play_tick(world, board, colliders, grid, log, tally, left, right, length)
        return 1
    for _ in range(free):
        turn_paddles(world, board, colliders, left, right, length)
    end_ticks(world, board, length, free)
    return free


@internal
def free_beats(
    world: Any, branch: Any, board: Any, colliders: Any, grid: Any, log: Any, tally: Any, length: float,
    horizon: int, memory: Any,
) -> int:  # fmt: skip
    """Move a world on, no button held, until LEAD beats before a ball is in reach of a paddle; by how many.

    `branch` is a copy of the world, to be used up.
    """
    arrival = 0
    while arrival < horizon and is_above(branch, board) and is_inside(branch, board):
        arrival += move(branch, board, colliders, grid, log, tally, False, False, length, horizon - arrival)
        memory.steps += 1
    beats = 0
    while beats < arrival - LEAD:
        beats += move(world, board, colliders, grid, log, tally, False, False, length, arrival - LEAD - beats)
        memory.steps += 1
    return beats


@inlined
def is_above(world: Any, board: Any) -> bool:
    """Whether no ball is in reach of a paddle."""
    a, b = world.ball[0], world.ball[1]
    return (a.id == 0 or a.x > board.paddle_top) and (b.id == 0 or b.x > board.paddle_top)


@internal
def look_ahead(
    world: Any, board: Any, colliders: Any, grid: Any, log: Any, tally: Any, plan: Any, memory: Any,
    beat: int, horizon: int, length: float, dry: float,
) -> float:  # fmt: skip
    """Carry a plan out on a copy of the world; what it is worth.

    A ball lost after t seconds counts −1/(1 + t/LOSS_TIME), points up to GAIN, a long time without points
    up to −1.
    """
    value, step = 0.0, 0
    start, score, drained = world.score, world.score, world.drained
    scored_at = 0
    line = board.paddle_top + RISE
    a, b = world.ball[0], world.ball[1]
    low_a, low_b, rises_a, rises_b = a.x < line, b.x < line, 0, 0
    while step < horizon and is_inside(world, board):
        now = beat + step
        left, right = buttons(plan, world, board, colliders, now, length)
        most = horizon - step
        if now < plan.until:
            most = min(most, next_change(plan, now) - now)
        step += move(world, board, colliders, grid, log, tally, left, right, length, most)
        memory.steps += 1
        if world.score != score:
            score, scored_at, dry = world.score, step, 0.0
        if world.drained != drained:
            value -= (world.drained - drained) / (1.0 + step * length / LOSS_TIME)
            drained = world.drained
        if low_a and a.x > line:
            rises_a += 1
        if low_b and b.x > line:
            rises_b += 1
        low_a, low_b = a.x < line, b.x < line
        if (a.id == 0 or rises_a >= RISES) and (b.id == 0 or rises_b >= RISES):
            break
    dry += (step - scored_at) * length
    gain = (score - start) / most_points(board, colliders)
    share = min(max((dry - DRY_FROM) / (DRY_TO - DRY_FROM), 0.0), 1.0)
    return value + GAIN * gain / (gain + GAIN_HALF) - share


@internal
def most_points(board: Any, colliders: Any) -> float:
    """The points of the most valuable part of a board, at least 1."""
    most = 1
    for index in range(board.collider_first, board.collider_end):
        most = max(most, colliders[index].points)
    return float(most)


class Planner:
    """The planner for a single world.

    It remembers the plan that it follows: another planner put before the same world begins anew and may play
    it in another way.
    """

    kind = PlayerKind.PLANNER

    def __init__(self) -> None:
        self._world: Any = None

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick."""
        if self._world is not world:
            self._world = world
            self.notes = Notes(1, len(world.records[2]))
        notes = self.notes
        left, right = planned(
            *world.records, world.grid, 0, *notes.arrays, 1.0 / world.tick_rate
        )
        return bool(left), bool(right)
