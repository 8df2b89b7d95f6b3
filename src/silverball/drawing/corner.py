"""Which corner of the board does a slant wall cut off? It is filled, for no ball can get there."""

from __future__ import annotations

import math

from silverball.table import Board, SlantWall

TOUCHES_BORDER = 1e-6  # [u] an end of a slant wall this close to a border lies on it


def corner_behind(board: Board, wall: SlantWall) -> tuple[tuple[float, float], ...] | None:
    """The triangle (x, z) [u], counter-clockwise, behind a slant wall from a side border to the top.

    None for every other wall.
    """
    half_length, half_width = 0.5 * board.length, 0.5 * board.width
    for low, high in ((wall.start, wall.end), (wall.end, wall.start)):
        on_side = math.isclose(abs(low[1]), half_width, abs_tol=TOUCHES_BORDER)
        on_top = math.isclose(high[0], half_length, abs_tol=TOUCHES_BORDER)
        if on_side and on_top and low != high:
            corner = (half_length, math.copysign(half_width, low[1]))
            turn = (high[1] - low[1]) * (corner[0] - low[0]) - (high[0] - low[0]) * (corner[1] - low[1])
            if turn == 0.0:
                return None
            return (low, high, corner) if turn > 0.0 else (low, corner, high)
    return None
