"""Plans of the planner: when each button will be held, and how a new plan is drawn or an old one varied.

A plan holds a few presses for each paddle, and the decision step from which on it leaves the paddles to the
reflex player. A decision step is the time between two decisions of the planner, 1/60 s at the usual tick
rates. Steps are counted from the world's tick 0, so a plan stays valid as time goes on.

Random numbers are a function of the world's seed and the step.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, TypeAlias

import numpy as np

from silverball.physics.kernel import as_int, internal
from silverball.physics.portable_math import uniform

PLANNER_KEY = 0x9_1A77  # makes the planner's random numbers independent of the world's
DRAWS = 4096  # random numbers reserved for one step
PRESSES = 2  # presses of each paddle in a plan: to catch a ball and to shoot it

PLAN = np.dtype(
    [
        ("start", "i8", (2, PRESSES)), ("end", "i8", (2, PRESSES)),  # [step] held from start to before end
        ("until", "i8"),  # [step] from here on the reflex player presses
        ("value", "f8"),  # see `look_ahead` in planner.py
    ],
    align=True,
)  # fmt: skip
PlanRecord: TypeAlias = Any  # a PLAN record

# All of the following are in decision steps, and chosen, not tuned.
FIRST_SPAN = 90  # a new press begins within this time: a caught ball comes to rest in it
SHORT, LONG = 10, 90  # upper limits of a short press (a shot) and of a long one (a catch)
GAP = 30  # longest time between two presses of a new plan
SHIFT = 8  # longest shift of a press when a plan is varied
NEW_SHARE = 0.3  # share of new plans; the others vary the best one


class Change(IntEnum):
    """What `vary_plan` changes; the numbers 2 and 3 shift a whole press."""

    START = 0  # the start of a press
    END = 1  # the end of a press
    DROP = 4  # a press is removed
    UNTIL = 5  # the step from which on the reflex player presses
    COUNT = 6


@internal
def is_held(plan: PlanRecord, side: int, step: int) -> bool:
    """Whether a plan holds a paddle's button in a step."""
    held = False
    for press in range(PRESSES):
        held = held or plan.start[side, press] <= step < plan.end[side, press]
    return held


@internal
def next_change(plan: PlanRecord, step: int) -> int:
    """The first step after this one in which the plan's buttons may change."""
    change: int = plan.until
    for side in range(2):
        for press in range(PRESSES):
            for edge in (plan.start[side, press], plan.end[side, press]):
                if step < edge < change:
                    change = edge
    return change


@internal
def clear_plan(plan: PlanRecord, step: int) -> None:
    """Make a plan that presses nothing and leaves the paddles to the reflex player from this step on."""
    for side in range(2):
        for press in range(PRESSES):
            plan.start[side, press], plan.end[side, press] = step, step
    plan.until = step
    plan.value = 0.0


@internal
def hold_all(plan: PlanRecord, left: bool, right: bool, step: int, steps: int) -> None:
    """Make a plan that holds these buttons for some steps and releases the other ones."""
    clear_plan(plan, step)
    plan.end[0, 0] = step + steps if left else step
    plan.end[1, 0] = step + steps if right else step
    plan.until = step + steps


@internal
def draw(seed: int, step: int, count: int, below: int) -> int:
    """The count-th random integer of a step, from 0 to below − 1."""
    return int(uniform(seed ^ PLANNER_KEY, step * DRAWS + count) * below)


@internal
def wants_new_plan(seed: int, step: int, count: int) -> bool:
    """Whether to draw a new plan, by the count-th random number of a step, rather than vary the best one."""
    return uniform(seed ^ PLANNER_KEY, step * DRAWS + count) < NEW_SHARE


@internal
def draw_press(
    plan: PlanRecord, side: int, press: int, earliest: int, seed: int, step: int, count: int
) -> int:
    """Draw a press, short or long; returns the count of random numbers used so far."""
    span = FIRST_SPAN if press == 0 else GAP
    begin = earliest + draw(seed, step, count, span)
    longest = SHORT if draw(seed, step, count + 1, 2) == 0 else LONG
    plan.start[side, press] = begin
    plan.end[side, press] = begin + 2 + draw(seed, step, count + 2, longest)
    return count + 3


@internal
def draw_plan(plan: PlanRecord, earliest: int, seed: int, step: int, count: int) -> int:
    """Draw a plan that begins at a step or later; returns the count of random numbers used so far."""
    clear_plan(plan, earliest)
    presses = 1 + draw(seed, step, count, 3)  # 1: left, 2: right, 3: both
    count += 1
    last = earliest
    for side in range(2):
        if presses & (side + 1) == 0:
            continue
        count = draw_press(plan, side, 0, earliest, seed, step, count)
        if draw(seed, step, count, 2) == 0:
            count = draw_press(plan, side, 1, plan.end[side, 0] + 1, seed, step, count + 1)
        else:
            count += 1
        last = max(last, plan.end[side, 0], plan.end[side, 1])
    plan.until = last + draw(seed, step, count, GAP)
    return count + 1


@internal
def vary_plan(plan: PlanRecord, earliest: int, seed: int, step: int, count: int) -> int:
    """Change one to three things about a plan; returns the count of random numbers used so far."""
    changes = 1 + draw(seed, step, count, 3)
    count += 1
    for _ in range(changes):
        side, press = draw(seed, step, count, 2), draw(seed, step, count + 1, PRESSES)
        change = draw(seed, step, count + 2, as_int(Change.COUNT))
        by = 1 + draw(seed, step, count + 3, SHIFT)
        if draw(seed, step, count + 4, 2) == 0:
            by = -by
        count += 5
        has_ended = plan.end[side, press] <= max(earliest, plan.start[side, press])
        if change == Change.UNTIL:
            plan.until = max(earliest, plan.until + 3 * by)
        elif has_ended:
            count = draw_press(plan, side, press, earliest, seed, step, count)
            plan.until = max(plan.until, plan.end[side, press])
        elif change == Change.DROP:
            plan.end[side, press] = plan.start[side, press]
        else:
            if change != Change.END:
                plan.start[side, press] += by
            if change != Change.START:
                plan.end[side, press] += by
            plan.until = max(plan.until, plan.end[side, press])
    return count
