"""The parts that a paddle would touch while it turns.

The least distance of a paddle to a part, over all its angles, is bounded by bisection: when a paddle turns by
an angle, no point of it moves further than that angle times the reach. So an interval of angles is clear if
the distance at its middle, minus the reach times half its width, is at least the clearance. Otherwise it is
halved, until the bound is below a ten-thousandth of a unit. Two paddles turn independently, so for them
rectangles of two angles are bisected.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from silverball.table.geometry import Floats, border_gaps, core_distances, distances, paddle_cores
from silverball.table.kinds import Board, Paddle
from silverball.table.model import Triangle

CLEARANCE = 0.02  # [u] least gap to a turning paddle; chosen: far above rounding, far below a ball
MIN_MOTION = 1e-4  # [u] least motion that is still bisected
CACHED = 256  # cached results; the boards of a recipe share their stationary parts
SPLITS = 40  # halvings at most; from 170° and a reach of 10 u, twenty are enough


def sweep_angles(paddle: Paddle) -> tuple[float, float]:
    """Return the angles [deg] between which a paddle turns."""
    return paddle.rest_angle, paddle.up_angle


@functools.lru_cache(maxsize=CACHED)
def touches_shape(paddle: Paddle, core: Triangle, radius: float) -> float | None:
    """Return an angle [deg] at which a paddle is too close to a stationary part, or None."""
    other = np.array(core)
    if float(distances(np.array(paddle.pivot), other)) - radius > paddle.reach + CLEARANCE:
        return None
    return _nearest_below(paddle, lambda cores: core_distances(cores, other[None]) - radius)


@functools.lru_cache(maxsize=CACHED)
def touches_border(paddle: Paddle, board: Board) -> tuple[float, int] | None:
    """Return an angle [deg] at which a paddle is too close to a border, and the border; or None."""
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
    """Return the angles [deg] of two paddles at which they are too close to each other, or None."""
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
        open_ = (gap - motion.sum(axis=1) < CLEARANCE) & (motion.sum(axis=1) > MIN_MOTION)
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
    """An angle [deg] at which the gap is below the clearance, near the smallest gap; or None."""
    edges = np.linspace(*sweep_angles(paddle), 17)
    low, high = edges[:-1], edges[1:]
    for _ in range(SPLITS):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        gap = gap_at(paddle_cores(paddle, middle))
        if (gap < CLEARANCE).any():
            return float(middle[np.argmin(gap)])
        motion = np.radians(half) * paddle.reach
        open_ = (gap - motion < CLEARANCE) & (motion > MIN_MOTION)
        if not open_.any():
            return None
        low, high, middle = low[open_], high[open_], middle[open_]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return None
