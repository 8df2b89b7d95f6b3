"""The camera: from points of the board to pixels and back.

A pinhole camera stands above the player's end and looks up the table. Pixel coordinates (across, down) are
real numbers; pixel (i, j) covers i … i + 1 and j … j + 1. A point of space is (x, y, z) [u] with y = 0 on the
playfield. With d the vector from the eye to a point, and the camera's unit vectors f (forward), r (right)
and u (up):

    across = middle + focal·(d·r)/(d·f),   down = middle − focal·(d·u)/(d·f)

The middle can be anywhere (a shifted lens), so that the board fills its area in a picture of any size.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import pygame

from silverball.drawing.dimensions import Dimensions
from silverball.table import Board

TILT = math.radians(38.0)  # angle of the view from straight down
DISTANCE = 2.8  # distance of the eye from the board's centre, by the longer side of the board
PANEL_SHAPE = 5.0  # width by height of the score panel: 160 × 32 dots
PANEL_MIN, PANEL_MAX = 0.42, 1.25  # width of the panel, in heights of the board's picture
MARGIN = 0.012  # by the content's width; left and right of the panel and between panel and board
BOARD_MARGIN = 0.004  # margin around the board, of the content's width


class Frustum(NamedTuple):
    """The camera as plain numbers, for kernels.

    Attributes:
        eye_x: Position of the eye [u]; its z is 0.
        eye_y: Height of the eye [u].
        sine: Of the tilt; forward is (sine, −cosine, 0), up in the picture is (cosine, sine, 0).
        cosine: Of the tilt.
        focal: Pixels per unit of (d·r)/(d·f).
        across: Middle of the lens [pixel].
        down: Middle of the lens [pixel].
    """

    eye_x: float
    eye_y: float
    sine: float
    cosine: float
    focal: float
    across: float
    down: float


class Camera:
    """The view of a board in a picture of a given size.

    Attributes:
        size: Width and height of the picture [pixel].
        board: The board.
        dimensions: The heights of its parts.
        panel: The area of the score panel [pixel]; without one, a line at the top.
        has_panel: Whether there is one above the board.
        frustum: The camera's numbers.
    """

    def __init__(self, board: Board, size: tuple[int, int], *, has_panel: bool = True) -> None:
        self.size = size
        self.board = board
        self.has_panel = has_panel
        self.dimensions = Dimensions.of(board)
        content = _Content(board, has_panel)
        scale = min(size[0] / content.width, size[1] / content.height)
        left = 0.5 * (size[0] - content.width * scale)
        top = 0.5 * (size[1] - content.height * scale)
        panel_width = content.panel_width * scale
        self.panel = pygame.Rect(
            round(0.5 * (size[0] - panel_width)),
            round(top + content.gap * scale),
            max(round(panel_width), 1),
            max(round(content.panel_height * scale), 1),
        )
        board_top = top + (content.height - content.board_height) * scale
        low_u, high_v = content.view[0], content.view[3]
        across = left + 0.5 * (content.width - content.board_width) * scale - low_u * scale
        eye_x, eye_y, sine, cosine = _pose(board)
        self.frustum = Frustum(eye_x, eye_y, sine, cosine, scale, across, board_top + high_v * scale)

    @property
    def scale(self) -> float:
        """Pixels per unit [u] across the middle of the board."""
        f = self.frustum
        return f.focal / (f.eye_y * f.cosine - f.eye_x * f.sine)

    def to_pixel(self, x: float, z: float, y: float = 0.0) -> tuple[float, float]:
        """Return the pixel coordinates (across, down) of a point at height y above the playfield."""
        f = self.frustum
        u, v = _project(x, y, z, f.eye_x, f.eye_y, f.sine, f.cosine)
        return f.across + f.focal * u, f.down - f.focal * v

    def ray(self, across: float, down: float) -> tuple[float, float, float]:
        """Return the direction (x, y, z) of the ray through a point of the picture, scaled to d·f = 1."""
        f = self.frustum
        u, v = (across - f.across) / f.focal, (f.down - down) / f.focal
        return f.sine + v * f.cosine, v * f.sine - f.cosine, u

    def to_board(self, across: float, down: float, y: float = 0.0) -> tuple[float, float]:
        """Return the point (x, z) at height y that is seen at a point of the picture."""
        f = self.frustum
        dx, dy, dz = self.ray(across, down)
        t = (y - f.eye_y) / dy
        return f.eye_x + t * dx, t * dz

    def box(
        self, low_x: float, high_x: float, low_z: float, high_z: float, low_y: float, high_y: float
    ) -> tuple[int, int, int, int]:
        """The pixels (left, top, right, bottom; the last two excluded) that a box of space can cover."""
        corners = [
            self.to_pixel(x, z, y) for x in (low_x, high_x) for z in (low_z, high_z) for y in (low_y, high_y)
        ]
        width, height = self.size
        left = min(max(math.floor(min(a for a, _ in corners)) - 1, 0), width)
        right = min(max(math.ceil(max(a for a, _ in corners)) + 1, left), width)
        top = min(max(math.floor(min(d for _, d in corners)) - 1, 0), height)
        bottom = min(max(math.ceil(max(d for _, d in corners)) + 1, top), height)
        return left, top, right, bottom


def best_size(board: Board, height: int, *, has_panel: bool = True) -> tuple[int, int]:
    """Return width and height [pixel], both even, of a picture that the table just fills."""
    content = _Content(board, has_panel)
    return max(2, 2 * round(0.5 * height * content.width / content.height)), height - height % 2


class _Content:
    """The size of what must be visible, in units of (d·r)/(d·f): the board, and any panel above it."""

    def __init__(self, board: Board, has_panel: bool) -> None:
        dimensions = Dimensions.of(board)
        pose = _pose(board)
        long, wide = dimensions.half_length + dimensions.rail, dimensions.half_width + dimensions.rail
        points = [
            _project(x, y, z, *pose)
            for x, low in ((-long, -dimensions.skirt), (long, 0.0))
            for z in (-wide, wide)
            for y in (low, dimensions.rail_height)
        ]
        points += [
            _project(dimensions.half_length, dimensions.top, z, *pose)
            for z in (-dimensions.half_width, dimensions.half_width)
        ]
        us, vs = [u for u, _ in points], [v for _, v in points]
        margin = BOARD_MARGIN * (max(us) - min(us))
        self.view = (min(us) - margin, max(us) + margin, min(vs) - margin, max(vs) + margin)
        self.board_width = self.view[1] - self.view[0]
        self.board_height = self.view[3] - self.view[2]
        self.panel_width = min(
            max(self.board_width, PANEL_MIN * self.board_height), PANEL_MAX * self.board_height
        )
        self.width = max(self.board_width, self.panel_width) if has_panel else self.board_width
        self.gap = MARGIN * self.panel_width
        self.panel_width -= 2.0 * self.gap
        self.panel_height = self.panel_width / PANEL_SHAPE if has_panel else 0.0
        self.height = self.board_height + (self.panel_height + 2.0 * self.gap if has_panel else 0.0)


def _pose(board: Board) -> tuple[float, float, float, float]:
    """Return the pose of the camera: x and y of the eye, sine and cosine of its tilt."""
    extent = max(board.length, board.width)
    sine, cosine = math.sin(TILT), math.cos(TILT)
    return -DISTANCE * extent * sine, DISTANCE * extent * cosine, sine, cosine


def _project(
    x: float, y: float, z: float, eye_x: float, eye_y: float, sine: float, cosine: float
) -> tuple[float, float]:
    dx, dy = x - eye_x, y - eye_y
    depth = dx * sine - dy * cosine
    return z / depth, (dx * cosine + dy * sine) / depth
