"""Rendering for people: pictures as the game draws them, and a window. Imports the drawing on first use."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from silverball.world import WorldBatch
from silverball.world.events import read_events

if TYPE_CHECKING:
    import pygame

    from silverball.drawing import Renderer
    from silverball.drawing.effects import Effects

SIZE = (330, 680)  # [pixel] width and height
ICON_SIDE = 64  # [pixel]
MAX_RENDERERS = 8  # each takes a few megabytes


class ViewerWindow:
    """A window that shows pictures at the speed of play.

    Args:
        rate: Pictures a second; `show` waits until the next one is due.

    Raises:
        NoDisplay: There is no display, and SDL_VIDEODRIVER does not name a driver that needs none.
    """

    _all: ClassVar[list[ViewerWindow]] = []  # all open ones

    def __init__(self, rate: int) -> None:
        import pygame

        from silverball.drawing.sketch import ball_icon
        from silverball.video_driver import NOT_A_SCREEN, open_video

        remedy = 'render_mode="rgb_array" needs none'
        open_video(remedy, without_display=os.environ.get("SDL_VIDEODRIVER") in NOT_A_SCREEN)
        self._window: pygame.Window | None = pygame.Window("Silverball", SIZE)
        self._window.set_icon(ball_icon(ICON_SIDE))
        self._clock, self._rate = pygame.Clock(), rate
        self._all.append(self)
        pygame.register_quit(self.close)

    @property
    def is_closed(self) -> bool:
        """Whether the window was closed."""
        return self._window is None

    def show(self, picture: NDArray[np.uint8]) -> None:
        """Show a picture, RGB [row, column, 3], and wait until the next one is due."""
        import pygame

        self._handle_events()
        if self._window is None:
            return
        pygame.surfarray.blit_array(self._window.get_surface(), picture.swapaxes(0, 1))
        self._window.flip()
        self._clock.tick(self._rate)

    def close(self) -> None:
        """Close the window."""
        if self._window is not None:
            self._all.remove(self)
            self._window.destroy()
            self._window = None

    def _handle_events(self) -> None:
        """Close the windows that the user has closed; the first window to poll receives the events of all."""
        import pygame

        # Keys and buttons stay in the queue. pygame does not return WINDOWCLOSE if asked for it alone.
        excluded = pygame.KEYDOWN, pygame.KEYUP, pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP
        for event in pygame.event.get(exclude=excluded):
            for screen in self._all.copy():
                if event.type == pygame.QUIT or (
                    event.type == pygame.WINDOWCLOSE and event.window == screen._window
                ):
                    screen.close()


class Viewer:
    """Draws worlds of a batch. Worlds on one board share its renderer, but not flashes, sparks or trails."""

    def __init__(self, batch: WorldBatch) -> None:
        self._batch = batch
        self._renderers: dict[int, Renderer] = {}
        self._effects: dict[int, Effects] = {}
        self._last_drawn: dict[int, tuple[int, int, int]] = {}  # of each world: board, seed, tick

    def picture(self, index: int) -> NDArray[np.uint8]:
        """The current picture of world `index`, RGB [row, column, 3]."""
        from silverball.drawing import Moment

        board = int(self._batch.board_of[index])
        renderer = self._renderer(board)
        renderer.effects = self._effects_of(index, board)
        return np.array(renderer.array(Moment.of_record(self._batch.state[index], self._batch.tick_rate)))

    def _effects_of(self, index: int, board: int) -> Effects:
        """The effects of the last moments of a world; a new episode or a restored state clears them."""
        from silverball.drawing.effects import Effects

        batch, record = self._batch, self._batch.state[index]
        before, now = self._last_drawn.get(index), (board, int(record["seed"]), int(record["tick"]))
        effects = self._effects.get(index)
        if effects is None or before is None or before[:2] != now[:2] or before[2] > now[2]:
            effects = self._effects[index] = Effects(batch.tables[board].board.ball_radius)
            before = None
        if before != now:
            height, names = batch.tables[board].board.height, batch.boards.names[board]
            effects.add_events(read_events(batch.logs[index], names, height), batch.tick_rate)
            self._last_drawn[index] = now
        return effects

    def _renderer(self, board: int) -> Renderer:
        from silverball.drawing import Renderer

        if board not in self._renderers:
            while len(self._renderers) >= MAX_RENDERERS:
                del self._renderers[next(iter(self._renderers))]
            self._renderers[board] = Renderer(self._batch.tables[board], SIZE)
        return self._renderers[board]
