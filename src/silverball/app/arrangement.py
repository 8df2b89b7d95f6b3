"""Where the table and the backglass are in a window: side by side where it is wide, else the table alone.

With a backglass the table has no score panel of its own, so it is larger. In a cabinet the backglass may fill
a second screen. Rectangles are in pixels.
"""

from __future__ import annotations

from typing import NamedTuple

import pygame

from silverball.drawing import best_size
from silverball.table import Board

MAX_HEIGHT = 4320  # [pixel] of a table
MIN_SHARE, MAX_SHARE = 0.5, 1.3  # width of a backglass, by the height of the window
OPENING_SHARE = 1.0  # the same when the window opens
MIN_SIZE = (200, 200)  # [pixel] of a backglass, below which its text is unreadable


class Arrangement(NamedTuple):
    """The parts of a window.

    Attributes:
        table: The whole table.
        backglass: What is beside it; None if there is too little room.
        is_apart: Whether the backglass is on a second screen, where it fills everything.
    """

    table: pygame.Rect
    backglass: pygame.Rect | None = None
    is_apart: bool = False


def arranged(
    board: Board, window_size: tuple[int, int], second_size: tuple[int, int] | None = None
) -> Arrangement:
    """Return where table and backglass are in a window of any size, or on two screens."""
    if second_size is not None:
        table = fitted(board, window_size, has_panel=False)
        return Arrangement(table, pygame.Rect((0, 0), second_size), is_apart=True)
    width, height = window_size
    table_size = _bare_size(board, height)
    free = width - table_size[0]
    if free < max(MIN_SHARE * height, MIN_SIZE[0]) or height < MIN_SIZE[1]:
        return Arrangement(fitted(board, window_size))
    backglass_width = min(free, round(MAX_SHARE * height))
    left = (free - backglass_width) // 2
    table = pygame.Rect((left, (height - table_size[1]) // 2), table_size)
    return Arrangement(table, pygame.Rect(table.right, 0, backglass_width, height))


def opening_size(board: Board, room: tuple[int, int]) -> tuple[int, int]:
    """Return the size of a new picture within a room: with a backglass if there is room for one."""
    width, height = room
    if arranged(board, room).backglass is None:
        return fitted(board, room).size
    return min(width, _bare_size(board, height)[0] + round(OPENING_SHARE * height)), height


def fitted(board: Board, window_size: tuple[int, int], *, has_panel: bool = True) -> pygame.Rect:
    """Return the largest area in the middle of a window into which the whole table fits."""
    window_width, window_height = window_size
    width, height = best_size(board, min(max(window_height, 2), MAX_HEIGHT), has_panel=has_panel)
    if width > window_width:
        height = max(2, height * window_width // width)
        width = best_size(board, height, has_panel=has_panel)[0]
    width, height = min(width, window_width), min(height, window_height)  # in windows of a few pixels
    return pygame.Rect((window_width - width) // 2, (window_height - height) // 2, width, height)


def _bare_size(board: Board, height: int) -> tuple[int, int]:
    return best_size(board, min(max(height, 2), MAX_HEIGHT), has_panel=False)
