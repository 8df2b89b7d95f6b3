"""The table in a window of any size: always whole, in the middle, and never a frozen picture.

Painting the still table takes a tenth of a second in a small window and a second on a very large one. A large
one is therefore shown at once from a smaller painting, while a thread paints the sharp one.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing import Camera, Moment, Renderer, best_size
from silverball.drawing.palette import ROOM
from silverball.drawing.still import paint_still
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.world import Event

AT_ONCE = 260_000  # pixels that are painted without a thread, in about 0.1 s


class Picture:
    """Draws a table into windows of changing size.

    Args:
        table: A finished table.
        window_size: Width and height of the window [pixel].
        board_seed: What the board was made from, if it is not always the same.
    """

    def __init__(self, table: Table, window_size: tuple[int, int], board_seed: int | None = None) -> None:
        self.table = table
        self._board_seed = board_seed
        self._window_size = window_size
        self.area = fitted(table, window_size)
        self._painting: _Painting | None = None
        self.renderer = self._new_renderer()

    @property
    def scale(self) -> float:
        """Pixels per table unit."""
        return self.renderer.camera.scale

    @property
    def apron(self) -> pygame.Rect:
        """The plate below the gutter [pixel of the table's area]: whatever covers it hides no play."""
        return self.renderer.apron

    @property
    def is_sharp(self) -> bool:
        """Whether the table on screen is painted at its full size."""
        return self._painting is None

    def fit(self, window_size: tuple[int, int]) -> None:
        """Follow the window's size."""
        if window_size == self._window_size:
            return
        self._window_size = window_size
        before, self.area = self.area, fitted(self.table, window_size)
        if self.area.size != before.size:
            effects = self.renderer.effects
            self.renderer = self._new_renderer()
            self.renderer.effects = effects

    def note(self, events: Iterable[Event], tick_rate: int) -> None:
        """Tell what happened since the last picture."""
        self.renderer.note(events, tick_rate)

    def draw(self, moment: Moment, window: pygame.Surface) -> pygame.Surface:
        """Draw a moment into a window of any size; returns the part of it that the table fills."""
        self.fit(window.get_size())
        self._sharpen()
        if window.get_size() != self.area.size:
            window.fill(ROOM)
        target = window.subsurface(self.area)
        self.renderer.draw(moment, target)
        return target

    def _new_renderer(self) -> Renderer:
        size = self.area.size
        pixels = size[0] * size[1]
        if pixels <= AT_ONCE:
            self._painting = None
            return Renderer(self.table, size, board_seed=self._board_seed)
        shrink = (AT_ONCE / pixels) ** 0.5
        small = (max(1, round(size[0] * shrink)), max(1, round(size[1] * shrink)))
        rough = paint_still(self.table, Camera(self.table.board, small))
        if self._painting is None or self._painting.is_done:
            self._painting = _Painting(self.table, size)
        return Renderer(self.table, size, rough, board_seed=self._board_seed)

    def _sharpen(self) -> None:
        painting = self._painting
        if painting is None or not painting.is_done:
            return
        if painting.size == self.area.size and painting.table is self.table:
            self.renderer.set_still(painting.pixels)
            self._painting = None
        else:  # the window has changed since
            self._painting = _Painting(self.table, self.area.size)


def fitted(table: Table, window_size: tuple[int, int]) -> pygame.Rect:
    """The largest area in the middle of a window that the whole table fits into."""
    width, height = window_size
    wide, high = best_size(table.board, max(height, 2))
    if wide > width:
        high = max(2, height * width // wide)
        wide = min(best_size(table.board, high)[0], width)
    return pygame.Rect((width - wide) // 2, (height - high) // 2, wide, high)


class _Painting:
    """A still table being painted in a thread."""

    def __init__(self, table: Table, size: tuple[int, int]) -> None:
        self.table = table
        self.size = size
        self.pixels: NDArray[np.uint8] = np.empty((0, 0, 3), np.uint8)
        self._thread = threading.Thread(target=self._paint, name="silverball painting", daemon=True)
        self._thread.start()

    @property
    def is_done(self) -> bool:
        return not self._thread.is_alive()

    def _paint(self) -> None:
        self.pixels = paint_still(self.table, Camera(self.table.board, self.size))
