"""Pictures of a table in play: the `Renderer`, and the functions behind `World.render`.

In the foreground (films, pictures for agents, tests) everything is baked before it is needed. In the
background (a window) there is a picture at once, from the cache or as a sketch; a thread bakes the better
one. Compiling runs in another process, because a compiler in a thread would make the game stutter.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.camera import Camera, best_size
from silverball.drawing.dotmatrix.canvas import Dots
from silverball.drawing.dotmatrix.score_panel import ScorePanel
from silverball.drawing.effects import Effects
from silverball.drawing.layout import Layout
from silverball.drawing.moment import Moment
from silverball.drawing.picture_cache import PictureCache
from silverball.drawing.pictures import load_baked_table, table_key
from silverball.drawing.sketch import SketchPainter, rgb_surface
from silverball.drawing.themes import ROOM, THEMES, Theme
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.drawing.background import Background
    from silverball.drawing.picture_provider import PictureProvider
    from silverball.game.view import GameEvent
    from silverball.world import Event, World

DEFAULT_HEIGHT = 480  # [pixel]
MAX_RENDERERS = 8  # renderers that `render` reuses; one of the default height takes about 5 MB


class Painter(Protocol):
    """Draws a moment onto a surface of its own."""

    def compose(self, moment: Moment, effects: Effects) -> pygame.Surface:
        """Draw a moment; the surface, 24 bits RGB, is used again for the next one."""


class Renderer:
    """Draws one table at one size and in one theme. It needs no display.

    The first renderer of a table bakes its picture, which takes a second or two; baked pictures are saved in
    the user's cache folder. After that a frame takes a fraction of a millisecond.

    Args:
        table: A finished table, such as `World.table`.
        size: Width and height of the picture [pixel]; the table is centred in it.
        height: Height of the picture [pixel], if no size is given; the width follows from the table's shape.
        theme: "neon", "parlour", "clear", or a `Theme`.
        effects: "full", or "less" for weaker flashes and neither sparks nor trails.
        board_seed: Shown with the score, if the board was made from it.
        background: Return at once and draw a sketch until the table is baked. Call `close` in the end.
        has_panel: Whether there is a score panel above the board.
        progress: Called with the share of the baking that is done, 0 to 1; not in the background.
        cache: Where baked pictures are kept; by default the user's cache folder.

    Attributes:
        apron: The plate below the gutter [pixel], which hides the balls below it.
        score_panel: The panel above the board [pixel], 5 by 1.

    Raises:
        ValueError: Both size and height are given, or a size or height below 1, or the theme is unknown.

    Examples:
        >>> import silverball as sb
        >>> world = sb.World("classic", seed=7)
        >>> renderer = sb.Renderer(world.table, height=160)
        >>> frames = []
        >>> for _ in range(3):
        ...     world.step(left=True, ticks=4)
        ...     renderer.add_events(world.events, world.tick_rate)  # flashes and sparks of the hits
        ...     frames.append(renderer.render(world))
        >>> frames[0].shape, frames[0].dtype
        ((160, 100, 3), dtype('uint8'))
    """

    def __init__(
        self,
        table: Table,
        size: tuple[int, int] | None = None,
        *,
        height: int | None = None,
        theme: str | Theme = "neon",
        effects: Literal["full", "less"] = "full",
        board_seed: int | None = None,
        background: bool = False,
        has_panel: bool = True,
        progress: Callable[[float], None] = lambda share: None,
        cache: PictureCache | None = None,
    ) -> None:
        self.table = table
        self.theme = _theme(theme)
        self.camera = Camera(table.board, _size(table, size, height, has_panel), has_panel=has_panel)
        self.effects = Effects(table.board.ball_radius, is_full=effects == "full")
        self.score_panel = self.camera.panel
        self.apron = _apron_area(self.camera)
        self._panel = ScorePanel(self.score_panel, self.theme, table, board_seed) if has_panel else None
        self._cache = cache or PictureCache()
        self._provider: PictureProvider | None = None
        self._background: Background | None = None
        self._painter: Painter
        if background:
            from silverball.drawing.background import Background
            from silverball.drawing.text import lettering

            lettering(table.name, self.camera.dimensions)  # cached here, because fonts are not thread-safe
            key = table_key(Layout.of(table), self.camera, self.theme)
            known = load_baked_table(self._cache, key)
            self._painter = SketchPainter(
                table, self.camera, self.theme, None if known is None else known.pixels
            )
            self._background = Background(table, self.camera, self.theme, self._cache, board_seed is not None)
        else:
            self._painter = self._baked(progress)

    @property
    def is_sharp(self) -> bool:
        """Whether the table is drawn in full quality, not as a sketch."""
        self._adopt_background()
        return not isinstance(self._painter, SketchPainter)

    def add_events(self, events: Iterable[Event], tick_rate: int) -> None:
        """Add events whose flashes and sparks the next pictures show.

        Args:
            events: What happened since the last picture, such as `World.events`.
            tick_rate: Ticks per second of the world.
        """
        self.effects.add_events(events, tick_rate)

    def add_game_events(self, events: Iterable[GameEvent], tick_rate: int) -> None:
        """Add events of a game whose light shows the next pictures show.

        Args:
            events: What happened since the last picture, such as `Game.events`.
            tick_rate: Ticks per second of the game.
        """
        self.effects.add_game_events(events, tick_rate)

    def draw(self, moment: Moment, target: pygame.Surface, dots: Dots | None = None) -> None:
        """Draw a moment onto a surface of the renderer's size.

        Args:
            moment: The state of play.
            target: Any surface; one of 24 bits whose bytes are RGB is fastest.
            dots: What the score panel shows; by default the moment's score.
        """
        target.blit(self._shifted(moment, dots), (0, 0))

    def surface(self, moment: Moment, dots: Dots | None = None) -> pygame.Surface:
        """Draw a moment onto a new surface of 24 bits, whose bytes are RGB."""
        target = rgb_surface(self.camera.size)
        self.draw(moment, target, dots)
        return target

    def render(self, world: World) -> NDArray[np.uint8]:
        """Draw a world as it is now: RGB, uint8 `[height, width, 3]`.

        Flashes and sparks are shown of events that were passed to `add_events`; balls leave trails from one
        call to the next.
        """
        return self.array(Moment.of(world)).copy()

    def array(self, moment: Moment, dots: Dots | None = None) -> NDArray[np.uint8]:
        """Draw a moment: RGB, uint8 `[height, width, 3]`, read-only."""
        width, height = self.camera.size
        pixels = np.frombuffer(pygame.image.tobytes(self._shifted(moment, dots), "RGB"), np.uint8)
        return pixels.reshape(height, width, 3)

    def wait(self, seconds: float | None = None) -> None:
        """Wait until the background has baked everything, moving parts included, or for some seconds."""
        if self._background is not None:
            self._background.wait(seconds)

    def close(self) -> None:
        """Stop the work in the background, and save what was baked."""
        if self._background is not None:
            self._background.close()
        if self._provider is not None:
            self._provider.save_sprites()

    def _shifted(self, moment: Moment, dots: Dots | None) -> pygame.Surface:
        """The picture of a moment, moved as far as a nudge has moved the cabinet."""
        surface = self._compose(moment, dots)
        x, z = moment.cabinet
        across, down = round(z * self.camera.scale), round(-x * self.camera.scale)
        if across == down == 0:
            return surface
        moved = rgb_surface(self.camera.size)
        moved.fill(ROOM)
        moved.blit(surface, (across, down))
        return moved

    def _compose(self, moment: Moment, dots: Dots | None) -> pygame.Surface:
        self._adopt_background()
        surface = self._painter.compose(moment, self.effects)
        if self._panel is not None:
            self._panel.draw(surface, moment, dots)
        return surface

    def _adopt_background(self) -> None:
        """Use the better picture once the background has baked it."""
        if self._background is not None and self._background.painter is not None:
            self._painter = self._background.painter

    def _baked(self, progress: Callable[[float], None]) -> Painter:
        from silverball.drawing.bake_threads import BakeThreads
        from silverball.drawing.compose import Composer
        from silverball.drawing.picture_provider import PictureProvider

        provider = PictureProvider(
            self.table, self.camera, self.theme, self._cache, BakeThreads(progress=progress)
        )
        self._provider = provider
        return Composer(
            self.table, self.camera, self.theme, provider.table(), provider.levels(), provider.baked_sprite
        )


_lock = threading.Lock()  # a renderer draws one picture at a time


def render(table: Table, record: Any, tick_rate: int, height: int, theme: str) -> NDArray[np.uint8]:
    """Draw a world record, without effects of earlier events: RGB, uint8 `[height, width, 3]`.

    The renderers of the last few tables are reused, so calls after the first are fast.
    """
    with _lock:
        return _renderer(table, height, theme).array(Moment.of_record(record, tick_rate)).copy()


@lru_cache(maxsize=MAX_RENDERERS)
def _renderer(table: Table, height: int, theme: str) -> Renderer:
    return Renderer(table, height=height, theme=theme, effects="less")


def _theme(theme: str | Theme) -> Theme:
    if isinstance(theme, Theme):
        return theme
    if theme not in THEMES:
        raise ValueError(f"theme must be one of {', '.join(THEMES)}, or a Theme, got {theme!r}")
    return THEMES[theme]


def _size(table: Table, size: tuple[int, int] | None, height: int | None, has_panel: bool) -> tuple[int, int]:
    if size is not None and height is not None:
        raise ValueError(f"give either size or height, got size {size} and height {height}")
    if size is None:
        height = DEFAULT_HEIGHT if height is None else height
        if height < 2:
            raise ValueError(f"height must be at least 2 pixels, got {height}")
        return best_size(table.board, height, has_panel=has_panel)[0], height
    if min(size) < 1:
        raise ValueError(f"size must be at least 1 by 1 pixel, got {size}")
    return size


def _apron_area(camera: Camera) -> pygame.Rect:
    dimensions = camera.dimensions
    side = dimensions.half_width - dimensions.thickness
    left, top = camera.to_pixel(dimensions.apron_top, -side, dimensions.apron_height)
    right = camera.to_pixel(dimensions.apron_top, side, dimensions.apron_height)[0]
    bottom = camera.to_pixel(-dimensions.half_length - dimensions.rail, side, dimensions.rail_height)[1]
    return pygame.Rect(round(left), round(top), round(right - left), max(round(bottom - top), 1))
