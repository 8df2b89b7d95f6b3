"""The window of the operating system: how is it opened, how large is it, and is there a display at all?

A pixel here is a real pixel of the screen: nothing is scaled, so it is sharp on high-density screens too.
"""

from __future__ import annotations

import pygame

from silverball.drawing.icon import ball_icon
from silverball.video import open_video

DECORATION = 88  # [pixel] of a screen's height that title bar and task bar may take
GREATEST_HEIGHT = 1200  # [pixel] of the window at first
ICON_SIDE = 64  # [pixel]
LEAST_SIZE = (170, 340)  # [pixel] below which nothing can be read
REMEDY = "`silverball demo` makes a film of a game without one, for example: silverball demo --out demo.gif"
FRAME_RATES = (60, 240)  # [1/s] the least and the greatest that is aimed at, whatever the screen says


class Screen:
    """The window.

    Args:
        title: In its title bar.
        without_display: Whether SDL's drivers that show nothing will do, as in tests.

    Raises:
        NoDisplay: There is no screen to open a window on.
    """

    def __init__(self, title: str, *, without_display: bool = False) -> None:
        open_video(REMEDY, without_display=without_display)
        self.desktop: tuple[int, int] = pygame.display.get_desktop_sizes()[0]
        self._title = title
        self._window: pygame.Window | None = None
        self.is_full = False

    @property
    def first_height(self) -> int:
        """The height [pixel] at which the whole window, its decorations included, fits the screen."""
        return min(self.desktop[1] - DECORATION, GREATEST_HEIGHT)

    @property
    def refresh_rate(self) -> int:
        """Pictures per second that the screen shows, as far as it says."""
        rates = pygame.display.get_desktop_refresh_rates()
        return min(max(rates[0] if rates else 0, FRAME_RATES[0]), FRAME_RATES[1])

    @property
    def surface(self) -> pygame.Surface:
        """What the window shows after the next `flip`, at its present size."""
        return self._opened.get_surface()

    def open(self, size: tuple[int, int]) -> None:
        """Show the window at a size."""
        self._window = pygame.Window(self._title, size, resizable=True, allow_high_dpi=True)
        self._window.minimum_size = LEAST_SIZE
        self._window.set_icon(ball_icon(ICON_SIDE))

    def owns(self, event: pygame.Event) -> bool:
        """Whether an event is about this window, and not about another one of this program."""
        return getattr(event, "window", self._window) is self._window

    def flip(self) -> None:
        """Show what has been drawn."""
        self._opened.flip()

    def toggle_full(self) -> None:
        """Fill the screen, or go back."""
        self.is_full = not self.is_full
        if self.is_full:
            self._opened.set_fullscreen(desktop=True)
        else:
            self._opened.set_windowed()
        pygame.mouse.set_visible(not self.is_full)

    def resize(self, size: tuple[int, int]) -> None:
        """Make the window another size."""
        self._opened.size = size

    def close(self) -> None:
        """Close the window."""
        if self._window is not None:
            self._window.destroy()
            self._window = None
        pygame.display.quit()

    @property
    def _opened(self) -> pygame.Window:
        assert self._window is not None, "open() comes first"
        return self._window
