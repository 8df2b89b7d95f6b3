"""Rendering for people: pictures as the game draws them, and a window. Imports the drawing on first use."""

from __future__ import annotations

import os
from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from silverball.referee.game_records import NOT_RUNNING
from silverball.world import WorldBatch
from silverball.world.events import read_events

if TYPE_CHECKING:
    import pygame

    from silverball.drawing import Renderer
    from silverball.drawing.effects import Effects

SIZE = (330, 680)  # [pixel] width and height, by default
ICON_SIDE = 64  # [pixel]
MAX_RENDERERS = 8  # each takes a few megabytes


class ViewerWindow:
    """A window that shows pictures at the speed of play.

    Args:
        rate: Pictures a second; `show` waits until the next one is due.
        size: Width and height of the pictures [pixel].

    Raises:
        NoDisplay: There is no display, and SDL_VIDEODRIVER does not name a driver that needs none.
    """

    _all: ClassVar[list[ViewerWindow]] = []  # all open ones

    def __init__(self, rate: int, size: tuple[int, int] = SIZE) -> None:
        import pygame

        from silverball.drawing.sketch import ball_icon
        from silverball.video_driver import NOT_A_SCREEN, open_video

        remedy = 'render_mode="rgb_array" needs none'
        open_video(remedy, without_display=os.environ.get("SDL_VIDEODRIVER") in NOT_A_SCREEN)
        self._window: pygame.Window | None = pygame.Window("Silverball", size)
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
    """Draws worlds of a batch. Worlds on one board share its renderer, but not flashes, sparks or trails.

    Args:
        batch: The worlds.
        games: The games that are played on them by rules, whose lamps are drawn, GAME records; None: none.
        size: Of a picture, width and height [pixel].
    """

    def __init__(
        self, batch: WorldBatch, games: NDArray[Any] | None = None, size: tuple[int, int] = SIZE
    ) -> None:
        self._batch, self._games, self.size = batch, games, size
        self._renderers: dict[int, Renderer] = {}
        self._effects: dict[int, Effects] = {}
        self._last_drawn: dict[int, tuple[int, int, int]] = {}  # of each world: board, seed, tick

    def picture(self, index: int) -> NDArray[np.uint8]:
        """The current picture of world `index`, RGB [row, column, 3]."""
        from silverball.drawing import Moment

        board = int(self._batch.board_of[index])
        renderer = self._renderer(board)
        renderer.effects = self._effects_of(index, board)
        moment = Moment.of_record(self._batch.state[index], self._batch.tick_rate)
        if self._games is not None:
            table, game = self._batch.tables[board], self._games[index]
            ends = zip(table.mode, game["mode_end"].tolist(), strict=False)
            colors = (mode.color for mode, end in ends if end != NOT_RUNNING and mode.color != "white")
            lamps = tuple(game["lamp"][: len(table.lamp)].tolist())
            score, color = int(game["score"]), next(colors, "white")
            moment = moment._replace(lamps=lamps, color=color, score=score)
        return np.array(renderer.array(moment))

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
            self._renderers[board] = Renderer(self._batch.tables[board], self.size)
        return self._renderers[board]


class RendersOne:
    """What shows a single environment: `render` and `close`. A subclass says what draws it."""

    render_mode: str | None
    metadata: dict[str, Any]
    _viewer: Viewer | None = None
    _screen: ViewerWindow | None = None

    @abstractmethod
    def _new_viewer(self) -> Viewer:
        """What draws the environment."""

    def render(self) -> NDArray[np.uint8] | None:
        """The table as the game draws it, RGB [row, column, 3]; None without a render mode.

        In the mode "human" a window shows it instead, after every reset and step, at the speed of play.
        Closing the window ends the rendering, not the episode.

        Raises:
            NoDisplay: The mode is "human", and there is no display.
        """
        if self.render_mode is None or (self._screen is not None and self._screen.is_closed):
            return None
        if self._viewer is None:
            self._viewer = self._new_viewer()
        if self.render_mode == "rgb_array":
            return self._viewer.picture(0)
        if self._screen is None:
            self._screen = ViewerWindow(self.metadata["render_fps"], self._viewer.size)
        self._screen.show(self._viewer.picture(0))
        return None

    def close(self) -> None:
        """Close the window, if one is open."""
        if self._screen is not None:
            self._screen.close()
