"""The table in a window of any size: always whole, in the middle, and never a frozen picture.

A new size is shown at once, as a sketch or as it was stored the last time, and gets sharp by itself.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal

import pygame

from silverball.drawing import Moment, Renderer, best_size
from silverball.drawing.palette import ROOM
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.world import Event


class Picture:
    """Draws a table into windows of changing size.

    Args:
        table: A finished table.
        window_size: Width and height of the window [pixel].
        board_seed: What the board was made from, if it is not always the same.
        theme: A name of the drawing's themes.
        effects: "full" or "less".
    """

    def __init__(
        self,
        table: Table,
        window_size: tuple[int, int],
        board_seed: int | None = None,
        *,
        theme: str = "neon",
        effects: Literal["full", "less"] = "full",
    ) -> None:
        self.table = table
        self._board_seed = board_seed
        self._theme = theme
        self._effects = effects
        self._window_size = window_size
        self.area = fitted(table, window_size)
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
        """Whether the table on screen is drawn at its best."""
        return self.renderer.is_sharp

    def fit(self, window_size: tuple[int, int]) -> None:
        """Follow the window's size."""
        if window_size == self._window_size:
            return
        self._window_size = window_size
        before, self.area = self.area, fitted(self.table, window_size)
        if self.area.size != before.size:
            effects = self.renderer.effects
            self.renderer.close()
            self.renderer = self._new_renderer()
            self.renderer.effects = effects

    def note(self, events: Iterable[Event], tick_rate: int) -> None:
        """Tell what happened since the last picture."""
        self.renderer.note(events, tick_rate)

    def draw(self, moment: Moment, window: pygame.Surface, dots: Any = None) -> pygame.Surface:
        """Draw a moment into a window of any size; returns the part of it that the table fills."""
        self.fit(window.get_size())
        if window.get_size() != self.area.size:
            window.fill(ROOM)
        target = window.subsurface(self.area)
        self.renderer.draw(moment, target, dots)
        return target

    def close(self) -> None:
        """End what is still done in the background."""
        self.renderer.close()

    def _new_renderer(self) -> Renderer:
        return Renderer(
            self.table,
            self.area.size,
            theme=self._theme,
            effects=self._effects,
            board_seed=self._board_seed,
            background=True,
        )


def fitted(table: Table, window_size: tuple[int, int]) -> pygame.Rect:
    """The largest area in the middle of a window that the whole table fits into."""
    width, height = window_size
    wide, high = best_size(table.board, max(height, 2))
    if wide > width:
        high = max(2, height * width // wide)
        wide = min(best_size(table.board, high)[0], width)
    return pygame.Rect((width - wide) // 2, (height - high) // 2, wide, high)
