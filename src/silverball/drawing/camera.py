"""Where does a point of the board lie in the picture, and the other way round?

The board is seen straight from above, x upwards and z to the right, with a rail around it and the score above
it; the whole of it is always visible. Pixel coordinates (across, down) are real numbers; pixel (i, j) covers
i … i + 1 and j … j + 1.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.table import Board

RAIL = 0.38  # [u] width of the rail around the board
MARGIN = 0.06  # [u] of room around the rail
SCORE_HEIGHT = 1.35  # [u] of the strip above the board


class Patch(NamedTuple):
    """A rectangle of whole pixels, and where their centres lie on the board.

    Attributes:
        left: First column.
        top: First row.
        x: Board x [u] of each row, shape [row, 1], float32.
        z: Board z [u] of each column, shape [1, column], float32.
        pixel: Side of a pixel [u].
    """

    left: int
    top: int
    x: NDArray[np.float32]
    z: NDArray[np.float32]
    pixel: float

    @property
    def rows_columns(self) -> tuple[slice, slice]:
        """The index of this patch into a picture."""
        return (
            slice(self.top, self.top + self.x.shape[0]),
            slice(self.left, self.left + self.z.shape[1]),
        )


class Camera:
    """The view of a board in a picture of a given size.

    Attributes:
        size: Width and height of the picture [pixel].
        scale: Pixels per table unit.
        middle: Where the centre of the board lies (across, down) [pixel].
    """

    def __init__(self, board: Board, size: tuple[int, int]) -> None:
        self.size = size
        self.board = board
        width, height = _view(board)
        self.scale = min(size[0] / width, size[1] / height)
        self.middle = (
            0.5 * size[0],
            0.5 * (size[1] - height * self.scale)
            + (SCORE_HEIGHT + MARGIN + RAIL + 0.5 * board.length) * self.scale,
        )

    @property
    def pixel(self) -> float:
        """Side of a pixel [u]."""
        return 1.0 / self.scale

    def to_pixel(self, x: float, z: float) -> tuple[float, float]:
        """The picture's point (across, down) of the board's point (x, z)."""
        return self.middle[0] + z * self.scale, self.middle[1] - x * self.scale

    def to_board(self, across: float, down: float) -> tuple[float, float]:
        """The board's point (x, z) of the picture's point (across, down)."""
        return (self.middle[1] - down) / self.scale, (across - self.middle[0]) / self.scale

    def patch(self, low_x: float, low_z: float, high_x: float, high_z: float) -> Patch:
        """The pixels that hold a rectangle of the board, cut off at the picture's edges."""
        left, bottom = self.to_pixel(low_x, low_z)
        right, top = self.to_pixel(high_x, high_z)
        first_column, end_column = _span(left, right, self.size[0])
        first_row, end_row = _span(top, bottom, self.size[1])
        columns = np.arange(first_column, end_column, dtype=np.float32) + np.float32(0.5)
        rows = np.arange(first_row, end_row, dtype=np.float32) + np.float32(0.5)
        x = (np.float32(self.middle[1]) - rows) / np.float32(self.scale)
        z = (columns - np.float32(self.middle[0])) / np.float32(self.scale)
        return Patch(first_column, first_row, x[:, None], z[None, :], self.pixel)

    def whole(self) -> Patch:
        """All pixels of the picture."""
        high_x, low_z = self.to_board(0.0, 0.0)
        low_x, high_z = self.to_board(*self.size)
        return self.patch(low_x, low_z, high_x, high_z)


def best_size(board: Board, height: int) -> tuple[int, int]:
    """Width and height [pixel], both even, of a picture of that height which the table just fills."""
    view_width, view_height = _view(board)
    return max(2, 2 * round(0.5 * height * view_width / view_height)), height - height % 2


def _view(board: Board) -> tuple[float, float]:
    """Width and height [u] of all that must be visible."""
    frame = 2.0 * (RAIL + MARGIN)
    return board.width + frame, board.length + frame + SCORE_HEIGHT


def _span(low: float, high: float, limit: int) -> tuple[int, int]:
    first = min(max(math.floor(low + 1e-6), 0), limit)
    return first, min(max(math.ceil(high - 1e-6), first), limit)
