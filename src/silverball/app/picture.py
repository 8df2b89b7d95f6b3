"""The table in a window of any size: always whole, in the middle, and never a frozen picture.

The renderer shows a sketch at once and sharpens by itself. While the window is being resized the last picture
is stretched; a new renderer comes when the size has stood for a moment.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal, NamedTuple

import pygame

from silverball.app.settings import Settings
from silverball.drawing import Moment, Renderer, best_size
from silverball.drawing.sketch import rgb_surface
from silverball.drawing.themes import ROOM
from silverball.table import Board, Table

if TYPE_CHECKING:
    from silverball.drawing.dotmatrix.canvas import Dots
    from silverball.world import Event

SETTLED = 0.25  # [s] for which a size has stood
GREATEST_DRAWN = 2880  # [pixel] of height; what is higher is stretched, for it would take a gigabyte
GREATEST_HEIGHT = 4320  # [pixel] to which a table grows


class _Shown(NamedTuple):
    """What a renderer was made for."""

    table: Table
    board_seed: int | None
    theme: str
    effects: Literal["full", "less"]


class Picture:
    """Draws tables into windows of changing size. `show` says which table, `draw` draws a moment.

    Args:
        window_size: Width and height of the window [pixel].
    """

    def __init__(self, window_size: tuple[int, int]) -> None:
        self._window_size = window_size
        self._resized: float | None = None  # when the window last got another size
        self._shown: _Shown | None = None
        self._renderer: Renderer | None = None
        self._stretched: pygame.Surface | None = None
        self.area = pygame.Rect((0, 0), window_size)

    @property
    def renderer(self) -> Renderer:
        """What draws."""
        assert self._renderer is not None, "show() comes first"
        return self._renderer

    @property
    def scale(self) -> float:
        """Pixels per table unit, about: of the width of the picture."""
        return self.area.width / (self.renderer.table.board.width + 1.0)

    @property
    def apron(self) -> pygame.Rect:
        """The plate below the gutter [pixel of the table's area]: whatever covers it hides no play."""
        return self._fitted(self.renderer.apron)

    @property
    def figures_area(self) -> pygame.Rect:
        """Where figures may be written [pixel of the table's area]: below the score display."""
        panel = self._fitted(self.renderer.score_panel)
        return pygame.Rect(panel.left, panel.bottom + 4, panel.width, self.area.height - panel.bottom)

    @property
    def is_sharp(self) -> bool:
        """Whether the table is drawn in full quality at its present size."""
        return self.renderer.is_sharp and self.renderer.camera.size == self._drawn_size

    def show(self, table: Table, board_seed: int | None, settings: Settings) -> None:
        """Draw this table from now on."""
        shown = _Shown(table, board_seed, settings.theme, settings.effects)
        if shown != self._shown:
            self._shown = shown
            self.area = fitted(table.board, self._window_size)
            self._renew()

    def note(self, events: Iterable[Event], tick_rate: int) -> None:
        """Tell what happened since the last picture."""
        if self._renderer is not None:
            self._renderer.add_events(events, tick_rate)

    def forget(self) -> None:
        """Another game begins."""
        if self._renderer is not None:
            self._renderer.effects.clear()

    def draw(self, moment: Moment, window: pygame.Surface, dots: Dots | None = None) -> pygame.Surface:
        """Draw a moment into a window of any size; returns the part of it that the table fills."""
        self._fit(window.get_size())
        if window.get_size() != self.area.size:
            window.fill(ROOM)
        target = window.subsurface(self.area)
        size = self.renderer.camera.size
        if size == self.area.size:
            self.renderer.draw(moment, target, dots)
            return target
        if self._stretched is None or self._stretched.get_size() != size:
            self._stretched = rgb_surface(size)
        self.renderer.draw(moment, self._stretched, dots)
        target.blit(pygame.transform.smoothscale(self._stretched, self.area.size), (0, 0))
        return target

    def close(self) -> None:
        """Stop sharpening."""
        if self._renderer is not None:
            self._renderer.close()

    def _fit(self, window_size: tuple[int, int]) -> None:
        now = time.monotonic()
        if window_size != self._window_size:
            self._window_size, self._resized = window_size, now
            self.area = fitted(self.renderer.table.board, window_size)
        elif self._resized is not None and now - self._resized >= SETTLED:
            self._resized = None
            if self._drawn_size != self.renderer.camera.size:
                self._renew()

    @property
    def _drawn_size(self) -> tuple[int, int]:
        """The size at which the table is drawn in the end."""
        if self.area.height <= GREATEST_DRAWN or self._shown is None:
            return self.area.size
        return best_size(self._shown.table.board, GREATEST_DRAWN)

    def _renew(self) -> None:
        assert self._shown is not None
        table, board_seed, theme, effects = self._shown
        before, self._renderer = (
            self._renderer,
            Renderer(
                table, self._drawn_size, theme=theme, effects=effects, board_seed=board_seed, background=True
            ),
        )
        if before is not None:
            before.close()
            if before.table == table and before.effects.is_full == self._renderer.effects.is_full:
                self._renderer.effects = before.effects

    def _fitted(self, box: pygame.Rect) -> pygame.Rect:
        """A rectangle of the renderer's picture in the table's area, which may be of another size."""
        wide, high = self.renderer.camera.size
        across, down = self.area.width / wide, self.area.height / high
        return pygame.Rect(
            round(box.left * across),
            round(box.top * down),
            round(box.width * across),
            round(box.height * down),
        )


def fitted(board: Board, window_size: tuple[int, int]) -> pygame.Rect:
    """The largest area in the middle of a window that the whole table fits into."""
    width, height = window_size
    wide, high = best_size(board, min(max(height, 2), GREATEST_HEIGHT))
    if wide > width:
        high = max(2, high * width // wide)
        wide = best_size(board, high)[0]
    wide, high = min(wide, width), min(high, height)  # where even two pixels are too many
    return pygame.Rect((width - wide) // 2, (height - high) // 2, wide, high)
