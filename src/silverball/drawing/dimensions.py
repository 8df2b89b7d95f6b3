"""Heights of the parts and dimensions of the cabinet. The physics does not need them: it has footprints only.

All in units [u] of the board. Heights scale with the ball. Most obstacles are lower than a ball, so that it
stays visible behind them and its shadow falls onto them; rails, caps of cylinders and the apron are taller.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from silverball.drawing.looks import LOOKS
from silverball.table import Board
from silverball.table.primitive import Finish, Point

REFERENCE_BALL_RADIUS = 0.25  # [u] for which the heights below are given
RAIL_SHARE = 0.044  # width of the rail, by the board's shorter side
MAX_RAIL = 1.0  # [u]
LEVEL_RISE = 0.5  # [u] from one level to the next
TOUCHES_BORDER = 1e-6  # [u] an end of a slant wall this close to a border lies on it


class Dimensions(NamedTuple):
    """Heights above the playfield and widths of everything that is built on a board [u].

    Attributes:
        unit: The factor of all heights; 1 for a ball of the usual size.
        half_length: Half of the board along x.
        half_width: Half of the board along z.
        thickness: Distance of the borders' surface from the board's edge.
        rail: Width of the rail outside the board.
        rail_height: Top of the rail.
        wall_height: Top of slant walls and of the corners behind them.
        prism_height: Top of a prism.
        body_height: Top of a bumper's body, below its cap.
        paddle_height: Top of a paddle.
        apron_height: Top of the apron, the plate that covers the gutter.
        apron_top: The x of its upper edge.
        skirt: How far the front of the cabinet reaches down.
        top: Upper bound of all heights.
        ball: Radius of a ball.
    """

    unit: float
    half_length: float
    half_width: float
    thickness: float
    rail: float
    rail_height: float
    wall_height: float
    prism_height: float
    body_height: float
    paddle_height: float
    apron_height: float
    apron_top: float
    skirt: float
    top: float
    ball: float

    @classmethod
    def of(cls, board: Board) -> Dimensions:
        """Return the dimensions of a board."""
        shorter = min(board.length, board.width)
        unit = min(board.ball_radius / REFERENCE_BALL_RADIUS, 0.25 * shorter)
        rail = min(RAIL_SHARE * shorter, MAX_RAIL)
        return cls(
            unit=unit,
            half_length=0.5 * board.length,
            half_width=0.5 * board.width,
            thickness=board.wall_thickness,
            rail=rail,
            rail_height=0.62 * unit,
            wall_height=LOOKS[Finish.WALL].height * unit,
            prism_height=LOOKS[Finish.PRISM].height * unit,
            body_height=LOOKS[Finish.BUMPER].height * unit,
            paddle_height=LOOKS[Finish.PADDLE].height * unit,
            apron_height=0.54 * unit,
            apron_top=max(board.gutter - board.ball_radius, -0.5 * board.length),
            skirt=0.5 * rail,
            top=0.95 * unit,
            ball=board.ball_radius,
        )


def corner_behind(board: Board, start: Point, end: Point) -> tuple[Point, Point, Point] | None:
    """Return the triangle (x, z) [u] that a wall from a side border to the top cuts off.

    It is counter-clockwise, and drawn as filled, because no ball can get there. None for every other wall.
    """
    half_length, half_width = 0.5 * board.length, 0.5 * board.width
    for low, high in ((start, end), (end, start)):
        on_side = math.isclose(abs(low[1]), half_width, abs_tol=TOUCHES_BORDER)
        on_top = math.isclose(high[0], half_length, abs_tol=TOUCHES_BORDER)
        if on_side and on_top and low != high:
            corner = (half_length, math.copysign(half_width, low[1]))
            turn = (high[1] - low[1]) * (corner[0] - low[0]) - (high[0] - low[0]) * (corner[1] - low[1])
            if turn == 0.0:
                return None
            return (low, high, corner) if turn > 0.0 else (low, corner, high)
    return None
