"""What is a plan: when will each button be held, and how is another one made of it?

A plan holds for each paddle a few presses, from one beat to another, and a beat from which on it leaves the
paddles to the reflex player. A beat is one decision of the planner, 1/60 s at the usual tick rates; beats are
counted from the world's tick 0, so that a plan need not be changed as time goes on.

Random numbers are a function of the world's seed and the beat.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from silverball.physics.kernel import internal
from silverball.physics.portable_math import uniform

PLANNER_KEY = 0x9_1A77  # sets the planner's random numbers apart from the world's own
DRAWS = 4096  # random numbers set aside for one beat
PRESSES = 2  # of each paddle in one plan: to catch a ball and to shoot it

PLAN = np.dtype(
    [
        ("start", "i8", (2, PRESSES)), ("end", "i8", (2, PRESSES)),  # [beat] held from start to before end
        ("until", "i8"),  # [beat] from here on the reflex player presses
        ("value", "f8"),  # what it was found to be worth; see planner.py
    ],
    align=True,
)  # fmt: skip

# All that follow are in beats, and chosen, not tuned.
FIRST_SPAN = 90  # within which a new press begins: long enough to let a caught ball come to rest
SHORT, LONG = 10, 90  # the longest short press (a shot) and the longest long one (a catch)
GAP = 30  # at most, between two presses of a new plan
SHIFT = 8  # at most, by which a press is shifted to make another plan
FRESH = 0.3  # of the plans are new, the others vary the best one


@internal
def is_held(plan: Any, side: int, beat: int) -> bool:
    """Whether a plan holds a paddle's button in a beat."""
    held = False
    for press in range(PRESSES):
        held = held or plan.start[side, press] <= beat < plan.end[side, press]
    return held


@internal
def next_change(plan: Any, beat: int) -> int:
    """The first beat after this one in which the plan's buttons may change."""
    change: int = plan.until
    for side in range(2):
        for press in range(PRESSES):
            for edge in (plan.start[side, press], plan.end[side, press]):
                if beat < edge < change:
                    change = edge
    return change


@internal
def clear_plan(plan: Any, beat: int) -> None:
    """Make a plan that presses nothing and leaves all to the reflex player from this beat on."""
    for side in range(2):
        for press in range(PRESSES):
            plan.start[side, press], plan.end[side, press] = beat, beat
    plan.until = beat
    plan.value = 0.0


@internal
def hold_all(plan: Any, left: bool, right: bool, beat: int, beats: int) -> None:
    """Make a plan that holds these buttons for some beats and lets the other ones go."""
    clear_plan(plan, beat)
    plan.end[0, 0] = beat + beats if left else beat
    plan.end[1, 0] = beat + beats if right else beat
    plan.until = beat + beats


@internal
def draw(seed: int, beat: int, count: int, below: int) -> int:
    """The count-th random whole number of a beat, from 0 to below − 1."""
    return int(uniform(seed ^ PLANNER_KEY, beat * DRAWS + count) * below)


@internal
def wants_new_plan(seed: int, beat: int, count: int) -> bool:
    """Whether to try something new with the count-th random number of a beat, or to vary the best plan."""
    return uniform(seed ^ PLANNER_KEY, beat * DRAWS + count) < FRESH


@internal
def draw_press(plan: Any, side: int, press: int, earliest: int, seed: int, beat: int, count: int) -> int:
    """Draw a press anew, short or long; how many random numbers have been used by then."""
    span = FIRST_SPAN if press == 0 else GAP
    begin = earliest + draw(seed, beat, count, span)
    longest = SHORT if draw(seed, beat, count + 1, 2) == 0 else LONG
    plan.start[side, press] = begin
    plan.end[side, press] = begin + 2 + draw(seed, beat, count + 2, longest)
    return count + 3


@internal
def draw_plan(plan: Any, earliest: int, seed: int, beat: int, count: int) -> int:
    """Draw a plan anew that begins at a beat or after it; how many random numbers have been used by then."""
    clear_plan(plan, earliest)
    presses = 1 + draw(seed, beat, count, 3)  # 1: left, 2: right, 3: both
    count += 1
    last = earliest
    for side in range(2):
        if presses & (side + 1) == 0:
            continue
        count = draw_press(plan, side, 0, earliest, seed, beat, count)
        if draw(seed, beat, count, 2) == 0:
            count = draw_press(plan, side, 1, plan.end[side, 0] + 1, seed, beat, count + 1)
        else:
            count += 1
        last = max(last, plan.end[side, 0], plan.end[side, 1])
    plan.until = last + draw(seed, beat, count, GAP)
    return count + 1


@internal
def vary_plan(plan: Any, earliest: int, seed: int, beat: int, count: int) -> int:
    """Change one to three things about a plan; how many random numbers have been used by then."""
    changes = 1 + draw(seed, beat, count, 3)
    count += 1
    for _ in range(changes):
        side, press = draw(seed, beat, count, 2), draw(seed, beat, count + 1, PRESSES)
        what = draw(seed, beat, count + 2, 6)
        by = 1 + draw(seed, beat, count + 3, SHIFT)
        if draw(seed, beat, count + 4, 2) == 0:
            by = -by
        count += 5
        is_over = plan.end[side, press] <= max(earliest, plan.start[side, press])
        if what == 5:
            plan.until = max(earliest, plan.until + 3 * by)
        elif is_over:
            count = draw_press(plan, side, press, earliest, seed, beat, count)
            plan.until = max(plan.until, plan.end[side, press])
        elif what == 4:
            plan.end[side, press] = plan.start[side, press]
        else:
            if what != 1:
                plan.start[side, press] += by
            if what != 0:
                plan.end[side, press] += by
            plan.until = max(plan.until, plan.end[side, press])
    return count
