"""How does a moment of play become a picture, at once and at its best? The face of the drawing.

In the foreground (films, pictures for agents, tests) everything is baked before it is needed. In the
background (a window) there is a picture at once: the one from the store, or a sketch; a thread brings the
rest, and compiled code is made in another process, for a compiler in a thread would make the game stutter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.camera import Camera
from silverball.drawing.dotmatrix.canvas import Dots
from silverball.drawing.dotmatrix.score_panel import ScorePanel
from silverball.drawing.effects import Effects
from silverball.drawing.moment import Moment
from silverball.drawing.picture_cache import Store
from silverball.drawing.pictures import load_still, still_key
from silverball.drawing.sketch import Pen, sketch, sketch_ball, sketch_paddle
from silverball.drawing.themes import THEMES, Theme
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.drawing.background import Background
    from silverball.drawing.picture_provider import Studio
    from silverball.world import Event


class Painter(Protocol):
    """What puts a moment onto a surface of its own."""

    def compose(self, moment: Moment, effects: Effects) -> pygame.Surface:
        """Draw a moment; the surface, 24 bits RGB, is used again for the next one."""


class Renderer:
    """Draws one table at one size.

    Args:
        table: A finished table.
        size: Width and height of the picture [pixel]; the table is fitted into it.
        theme: A name of `THEMES`, or a theme.
        effects: "full", or "less" for no sparks and trails and weaker flashes.
        board_seed: Written beside the score if the board was made from it.
        background: Whether a picture is wanted at once, and the best one as soon as it is baked. Then call
            `close` when it is wanted no more.
        progress: Told how much of the baking is done, 0 to 1, in the foreground.
        store: Where baked pictures are kept; the user's cache directory if not given.

    Attributes:
        apron: The plate below the gutter [pixel], under which no play is seen.
        score_panel: The panel above the board [pixel], 5 by 1.

    Example:
        >>> import silverball as sb
        >>> from silverball.drawing import Moment, Renderer
        >>> table = sb.load_table("classic")
        >>> Renderer(table, (66, 106)).array(Moment.before(table)).shape
        (106, 66, 3)
    """

    def __init__(
        self,
        table: Table,
        size: tuple[int, int],
        *,
        theme: str | Theme = "neon",
        effects: Literal["full", "less"] = "full",
        board_seed: int | None = None,
        background: bool = False,
        progress: Callable[[float], None] = lambda share: None,
        store: Store | None = None,
    ) -> None:
        self.table = table
        self.theme = theme if isinstance(theme, Theme) else THEMES[theme]
        self.camera = Camera(table.board, size)
        self.effects = Effects(table.board.ball_radius, is_full=effects == "full")
        self.score_panel = self.camera.panel
        self.apron = _apron_area(self.camera)
        self._panel = ScorePanel(self.score_panel, self.theme, table, board_seed)
        self._store = store or Store()
        self._studio: Studio | None = None
        self._background: Background | None = None
        self._painter: Painter
        if background:
            from silverball.drawing.background import Background
            from silverball.drawing.lettering import lettering

            lettering(table.name, self.camera.build)  # here, for fonts are not made for threads
            key = still_key(table, self.camera, self.theme)
            known = load_still(self._store, key)
            self._painter = Sketcher(table, self.camera, self.theme, None if known is None else known.pixels)
            self._background = Background(table, self.camera, self.theme, self._store, board_seed is not None)
        else:
            self._painter = self._baked(progress)

    @property
    def is_sharp(self) -> bool:
        """Whether the table is drawn at its best."""
        self._take_over()
        return not isinstance(self._painter, Sketcher)

    def note(self, events: Iterable[Event], tick_rate: int) -> None:
        """Tell what happened since the last picture, so that it can be seen in the next ones."""
        self.effects.note(events, tick_rate)

    def draw(self, moment: Moment, target: pygame.Surface, dots: Dots | None = None) -> None:
        """Draw a moment onto a surface of the renderer's size.

        Args:
            moment: What there is to see.
            target: Any surface; one of 24 bits whose bytes are RGB is fastest.
            dots: What the score panel shows, a `Dots`; the moment's score if not given.
        """
        target.blit(self._compose(moment, dots), (0, 0))

    def surface(self, moment: Moment, dots: Dots | None = None) -> pygame.Surface:
        """A moment as a new surface of 24 bits, whose bytes are RGB."""
        target = rgb_surface(self.camera.size)
        self.draw(moment, target, dots)
        return target

    def array(self, moment: Moment, dots: Dots | None = None) -> NDArray[np.uint8]:
        """A moment as RGB, uint8, shape [row, column, 3]."""
        width, height = self.camera.size
        pixels = np.frombuffer(pygame.image.tobytes(self._compose(moment, dots), "RGB"), np.uint8)
        return pixels.reshape(height, width, 3)

    def wait(self, seconds: float | None = None) -> None:
        """Wait until all that is baked in the background is there, the paddles at every angle too."""
        if self._background is not None:
            self._background.wait(seconds)

    def close(self) -> None:
        """End the work in the background; keep what was baked."""
        if self._background is not None:
            self._background.close()
        if self._studio is not None:
            self._studio.save_paddles()

    def _compose(self, moment: Moment, dots: Dots | None) -> pygame.Surface:
        self._take_over()
        surface = self._painter.compose(moment, self.effects)
        self._panel.draw(surface, moment, dots)
        return surface

    def _take_over(self) -> None:
        """Use what the background has made ready."""
        if self._background is not None and self._background.painter is not None:
            self._painter = self._background.painter

    def _baked(self, progress: Callable[[float], None]) -> Painter:
        from silverball.drawing.bake_threads import Workshop
        from silverball.drawing.compose import Composer
        from silverball.drawing.picture_provider import Studio

        studio = Studio(self.table, self.camera, self.theme, self._store, Workshop(progress=progress))
        self._studio = studio
        return Composer(self.table, self.camera, self.theme, studio.still(), studio.baked_paddle)


class Sketcher:
    """Draws moments without compiled code.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its look.
        pixels: The still table if it is at hand, RGB [row, column, 3]; else it is sketched.
    """

    def __init__(
        self, table: Table, camera: Camera, theme: Theme, pixels: NDArray[np.uint8] | None = None
    ) -> None:
        self._paddles = table.paddle
        self._theme = theme
        if pixels is None:
            pixels = sketch(table, camera, theme)
        self._still = pygame.image.frombuffer(pixels.tobytes(), camera.size, "RGB")
        self._surface = rgb_surface(camera.size)
        self._pen = Pen(self._surface, camera)

    def compose(self, moment: Moment, effects: Effects) -> pygame.Surface:
        """Draw a moment; the surface, 24 bits RGB, is used again for the next one."""
        self._surface.blit(self._still, (0, 0))
        for _ in effects.trails(moment):
            pass  # so that they are there when the better picture comes
        balls = [*moment.balls, *effects.dives(moment.time)]
        angles = dict(zip(("left", "right"), moment.angles, strict=True))
        for ball in balls:
            sketch_ball(self._pen, ball.x, ball.z)
        for paddle in self._paddles:
            sketch_paddle(self._pen, paddle, angles[paddle.side], self._theme)
        return self._surface


def rgb_surface(size: tuple[int, int]) -> pygame.Surface:
    """A surface of 24 bits whose bytes are RGB; it needs no display."""
    return pygame.image.frombuffer(bytearray(3 * size[0] * size[1]), size, "RGB")


def _apron_area(camera: Camera) -> pygame.Rect:
    build = camera.build
    side = build.half_width - build.thickness
    left, top = camera.to_pixel(build.apron_top, -side, build.apron_height)
    right = camera.to_pixel(build.apron_top, side, build.apron_height)[0]
    bottom = camera.to_pixel(-build.half_length - build.rail, side, build.rail_height)[1]
    return pygame.Rect(round(left), round(top), round(right - left), max(round(bottom - top), 1))
