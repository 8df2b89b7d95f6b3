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
from typing import TYPE_CHECKING

import numpy as np

from silverball.table.geometry import (
    Floats,
    Indices,
    Pieces,
    Triangle,
    border_gaps,
    core_distances,
    distances,
    level_mask,
    moving_pieces,
    moving_reach,
)
from silverball.table.primitive import Mover, Primitive

if TYPE_CHECKING:
    from silverball.table.kinds import Board

CLEARANCE = 0.02  # [u] least gap to a turning paddle; chosen: far above rounding, far below a ball
MIN_MOTION = 1e-4  # [u] least motion that is still bisected
CACHED = 4096  # cached results; the boards of a recipe share the parts of the recipe
SPLITS = 40  # halvings at most; from 240° and a reach of 10 u, twenty-one are enough


def near_paddle(paddle: Primitive, pieces: Pieces) -> Indices:
    """Return the indices of the pieces that a paddle could touch, by its reach and its levels."""
    away = distances(np.array(_mover(paddle).pivot), pieces.core) - pieces.radius
    meets = pieces.levels & level_mask(paddle.levels) != 0
    return np.nonzero(meets & (away <= moving_reach(paddle) + CLEARANCE))[0]


@functools.lru_cache(maxsize=CACHED)
def touches_piece(paddle: Primitive, core: Triangle, radius: float) -> float | None:
    """Return an angle [deg] at which a paddle is too close to a piece of a part, or None."""
    other = np.array(core)

    def gap(cores: Floats, radii: Floats) -> Floats:
        nearest: Floats = (core_distances(cores, other) - radii - radius).min(axis=-1)
        return nearest

    return _nearest_below(paddle, gap)


@functools.lru_cache(maxsize=CACHED)
def touches_border(paddle: Primitive, board: Board) -> tuple[float, int] | None:
    """Return an angle [deg] at which a paddle is too close to a border, and the border; or None."""
    for border in range(3):

        def gap(cores: Floats, radii: Floats, border: int = border) -> Floats:
            nearest: Floats = (border_gaps(cores, board)[..., border].min(axis=-1) - radii).min(axis=-1)
            return nearest

        angle = _nearest_below(paddle, gap)
        if angle is not None:
            return angle, border
    return None


@functools.lru_cache(maxsize=CACHED)
def touches_paddle(first: Primitive, second: Primitive) -> tuple[float, float] | None:
    """Return the angles [deg] of two paddles at which they are too close to each other, or None."""
    one, other = _mover(first), _mover(second)
    reach = np.array([moving_reach(first), moving_reach(second)])
    if not level_mask(first.levels) & level_mask(second.levels):
        return None
    if math.dist(one.pivot, other.pivot) > reach.sum() + CLEARANCE:
        return None
    low = np.array([[one.rest_angle, other.rest_angle]])
    high = np.array([[one.up_angle, other.up_angle]])
    for _ in range(2 * SPLITS):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        cores, radii = moving_pieces(first, middle[:, 0])
        other_cores, other_radii = moving_pieces(second, middle[:, 1])
        between = core_distances(cores[:, :, None], other_cores[:, None]) - radii[:, None] - other_radii
        gap = between.min(axis=(1, 2))
        if (gap < CLEARANCE).any():
            worst = int(np.argmin(gap))
            return math.degrees(middle[worst, 0]), math.degrees(middle[worst, 1])
        motion = half * reach
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


def _mover(paddle: Primitive) -> Mover:
    assert paddle.mover is not None
    return paddle.mover


def _nearest_below(paddle: Primitive, gap_at: Callable[[Floats, Floats], Floats]) -> float | None:
    """An angle [deg] at which the gap is below the clearance, near the smallest gap; or None."""
    reach = moving_reach(paddle)
    edges = np.linspace(_mover(paddle).rest_angle, _mover(paddle).up_angle, 17)
    low, high = edges[:-1], edges[1:]
    for _ in range(SPLITS):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        gap = gap_at(*moving_pieces(paddle, middle))
        if (gap < CLEARANCE).any():
            return math.degrees(middle[np.argmin(gap)])
        motion = half * reach
        open_ = (gap - motion < CLEARANCE) & (motion > MIN_MOTION)
        if not open_.any():
            return None
        low, high, middle = low[open_], high[open_], middle[open_]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return None
