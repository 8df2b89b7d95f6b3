"""The table in a window of any size: whole, and drawn in every frame.

The renderer shows a sketch immediately and refines it in the background. While the window is being resized
the last picture is stretched; a new renderer is made once the size has settled.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal, NamedTuple

import pygame

from silverball.app.arrangement import Arrangement, arranged
from silverball.app.settings import Settings
from silverball.drawing import Moment, Renderer, best_size
from silverball.drawing.sketch import rgb_surface
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.drawing.dotmatrix.canvas import Dots
    from silverball.game.view import GameEvent
    from silverball.world import Event

SETTLE_TIME = 0.25  # [s] without a change of size
MAX_DRAWN = 2880  # [pixel] of height; larger pictures are stretched, since they would take a gigabyte


class _Shown(NamedTuple):
    """The parameters of a renderer."""

    table: Table
    board_seed: int | None
    theme: str
    effects: Literal["full", "less"]


class Picture:
    """Draws tables into windows of changing size: `show` selects the table, `draw` draws a moment.

    Args:
        window_size: Width and height of the window [pixel].
        second_size: The same of the backglass on a screen of its own; None without one.

    Attributes:
        arrangement: Where table and backglass are in the window.
    """

    def __init__(self, window_size: tuple[int, int], second_size: tuple[int, int] | None = None) -> None:
        self._window_size, self._second_size = window_size, second_size
        self._resized: float | None = None  # time of the last change of size
        self._shown: _Shown | None = None
        self._renderer: Renderer | None = None
        self._stretched: pygame.Surface | None = None
        self.arrangement = Arrangement(pygame.Rect((0, 0), window_size))

    @property
    def area(self) -> pygame.Rect:
        """The part of the window that the table fills."""
        return self.arrangement.table

    @property
    def renderer(self) -> Renderer:
        """The renderer of the current table."""
        assert self._renderer is not None, "show() comes first"
        return self._renderer

    @property
    def scale(self) -> float:
        """Pixels per table unit, approximately: across the width of the picture."""
        return self.area.width / (self.renderer.table.board.width + 1.0)

    @property
    def apron(self) -> pygame.Rect:
        """The plate below the gutter [pixel of the table's area], where text hides nothing of the play."""
        return self._fitted(self.renderer.apron)

    @property
    def figures_area(self) -> pygame.Rect:
        """The area for debug figures [pixel of the table's area]: below the score display."""
        panel = self._fitted(self.renderer.score_panel)
        return pygame.Rect(panel.left, panel.bottom + 4, panel.width, self.area.height - panel.bottom)

    @property
    def is_sharp(self) -> bool:
        """Whether the table is drawn in full quality at its current size."""
        return self.renderer.is_sharp and not self._is_outdated

    def show(self, table: Table, board_seed: int | None, settings: Settings) -> None:
        """Select the table, its seed and the settings that `draw` uses."""
        shown = _Shown(table, board_seed, settings.theme, settings.effects)
        if shown != self._shown:
            self._shown = shown
            self.arrangement = arranged(table.board, self._window_size, self._second_size)
            self._renew()

    def add_events(self, events: Iterable[Event], tick_rate: int) -> None:
        """Pass the events since the last frame on to the renderer."""
        if self._renderer is not None:
            self._renderer.add_events(events, tick_rate)

    def add_game_events(self, events: Iterable[GameEvent], tick_rate: int) -> None:
        """Pass the events of the game since the last frame on to the renderer."""
        if self._renderer is not None:
            self._renderer.add_game_events(events, tick_rate)

    def reset(self) -> None:
        """Reset the effects, because another session begins."""
        if self._renderer is not None:
            self._renderer.effects.clear()

    def draw(self, moment: Moment, window: pygame.Surface, dots: Dots | None = None) -> pygame.Surface:
        """Draw a moment into a window of any size; return the part of it that the table fills."""
        self.fit(window.get_size(), self._second_size)
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
        """Stop the background work."""
        if self._renderer is not None:
            self._renderer.close()

    def fit(self, window_size: tuple[int, int], second_size: tuple[int, int] | None = None) -> None:
        """Arrange the parts of windows of other sizes; the renderer follows once the sizes have settled."""
        now = time.monotonic()
        if (window_size, second_size) != (self._window_size, self._second_size):
            self._window_size, self._second_size, self._resized = window_size, second_size, now
            self.arrangement = arranged(self.renderer.table.board, window_size, second_size)
        elif self._resized is not None and now - self._resized >= SETTLE_TIME:
            self._resized = None
            if self._is_outdated:
                self._renew()

    @property
    def _has_panel(self) -> bool:
        return self.arrangement.backglass is None

    @property
    def _is_outdated(self) -> bool:
        """Whether the renderer is one for another arrangement."""
        camera = self.renderer.camera
        return camera.size != self._drawn_size or camera.has_panel != self._has_panel

    @property
    def _drawn_size(self) -> tuple[int, int]:
        """The size of the picture before stretching."""
        if self.area.height <= MAX_DRAWN or self._shown is None:
            return self.area.size
        return best_size(self._shown.table.board, MAX_DRAWN, has_panel=self._has_panel)

    def _renew(self) -> None:
        assert self._shown is not None
        table, board_seed, theme, effects = self._shown
        before, self._renderer = (
            self._renderer,
            Renderer(
                table,
                self._drawn_size,
                theme=theme,
                effects=effects,
                board_seed=board_seed,
                background=True,
                has_panel=self._has_panel,
            ),
        )
        if before is not None:
            before.close()
            if before.table == table and before.effects.is_full == self._renderer.effects.is_full:
                self._renderer.effects = before.effects

    def _fitted(self, box: pygame.Rect) -> pygame.Rect:
        """Scale a rectangle of the renderer's picture to the table's area."""
        width, height = self.renderer.camera.size
        scale_x, scale_y = self.area.width / width, self.area.height / height
        return pygame.Rect(
            round(box.left * scale_x),
            round(box.top * scale_y),
            round(box.width * scale_x),
            round(box.height * scale_y),
        )
