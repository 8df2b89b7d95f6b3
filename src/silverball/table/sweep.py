"""What would a turning paddle touch?

The nearest that a paddle comes to a part, over all its angles, is found by bisection with a bound that
nothing can slip through: when a paddle turns by an angle, none of its points moves further than that
angle times the reach. So an interval of angles is clear when the distance at its middle, less the reach
times half its width, leaves the clearance; else it is halved, until it is so narrow that the bound is
worth a ten-thousandth of a unit. Two paddles turn independently, so for them it is a bisection of
rectangles: one angle of each.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from silverball.table.geometry import Floats, border_gaps, core_distances, distances, paddle_cores
from silverball.table.parts import Board, Paddle, Triangle

CLEARANCE = 0.02  # [u] that a turning paddle must leave; chosen: far above rounding, far below a ball
FINEST = 1e-4  # [u] a motion smaller than this is not looked at more closely
CACHED = 256  # answers that are kept: boards of one recipe ask the same of their standing parts
SPLITS = 40  # halvings at most; from 170° and a reach of 10 u, twenty are enough


def sweep_angles(paddle: Paddle) -> tuple[float, float]:
    """The angles [deg] between which a paddle turns."""
    return paddle.rest_angle, paddle.up_angle


@functools.lru_cache(maxsize=CACHED)
def touches_shape(paddle: Paddle, core: Triangle, radius: float) -> float | None:
    """The angle [deg] at which a paddle comes too near to a standing part; None if it never does."""
    other = np.array(core)
    if float(distances(np.array(paddle.pivot), other)) - radius > paddle.reach + CLEARANCE:
        return None
    return _nearest_below(paddle, lambda cores: core_distances(cores, other[None]) - radius)


@functools.lru_cache(maxsize=CACHED)
def touches_border(paddle: Paddle, board: Board) -> tuple[float, int] | None:
    """The angle [deg] at which a paddle comes too near to a border, and which border; None if never."""
    for border in range(3):

        def gap(cores: Floats, border: int = border) -> Floats:
            nearest: Floats = border_gaps(cores, board)[..., border].min(axis=-1)
            return nearest

        angle = _nearest_below(paddle, gap)
        if angle is not None:
            return angle, border
    return None


@functools.lru_cache(maxsize=CACHED)
def touches_paddle(first: Paddle, second: Paddle) -> tuple[float, float] | None:
    """The angles [deg] of two paddles at which they come too near to each other; None if they never do."""
    if math.dist(first.pivot, second.pivot) > first.reach + second.reach + CLEARANCE:
        return None
    low = np.array([[first.rest_angle, second.rest_angle]])
    high = np.array([[first.up_angle, second.up_angle]])
    reach = np.array([first.reach, second.reach])
    for _ in range(2 * SPLITS):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        gap = core_distances(paddle_cores(first, middle[:, 0]), paddle_cores(second, middle[:, 1]))
        if (gap < CLEARANCE).any():
            worst = int(np.argmin(gap))
            return float(middle[worst, 0]), float(middle[worst, 1])
        motion = np.radians(half) * reach
        open_ = (gap - motion.sum(axis=1) < CLEARANCE) & (motion.sum(axis=1) > FINEST)
        if not open_.any():
            return None
        low, high, middle, wider = low[open_], high[open_], middle[open_], np.argmax(motion[open_], axis=1)
        row = np.arange(len(low))
        first_half, second_half = high.copy(), low.copy()
        first_half[row, wider] = middle[row, wider]
        second_half[row, wider] = middle[row, wider]
        low, high = np.concatenate([low, second_half]), np.concatenate([first_half, high])
    return None


def _nearest_below(paddle: Paddle, gap_at: Callable[[Floats], Floats]) -> float | None:
    """An angle [deg] at which the gap falls below the clearance, near the smallest; None if there is none."""
    edges = np.linspace(*sweep_angles(paddle), 17)
    low, high = edges[:-1], edges[1:]
    for _ in range(SPLITS):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        gap = gap_at(paddle_cores(paddle, middle))
        if (gap < CLEARANCE).any():
            return float(middle[np.argmin(gap)])
        motion = np.radians(half) * paddle.reach
        open_ = (gap - motion < CLEARANCE) & (motion > FINEST)
        if not open_.any():
            return None
        low, high, middle = low[open_], high[open_], middle[open_]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return None
