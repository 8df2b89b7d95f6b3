"""The window of the operating system: how is it opened, how large is it, and is there a display at all?

A pixel here is a real pixel of the screen: nothing is scaled, so it is sharp on high-density screens too.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pygame

from silverball.drawing.icon import ball_icon
from silverball.errors import NoDisplay

DECORATION = 88  # [pixel] of a screen's height that title bar and task bar may take
GREATEST_HEIGHT = 1200  # [pixel] of the window at first
ICON_SIDE = 64  # [pixel]
LEAST_SIZE = (170, 340)  # [pixel] below which nothing can be read
FRAME_RATES = (60, 240)  # [1/s] the least and the greatest that is aimed at, whatever the screen says
_NOT_A_SCREEN = ("dummy", "offscreen", "evdev")


class Screen:
    """The window.

    Args:
        title: In its title bar.
        without_display: Whether SDL's drivers that show nothing will do, as in tests.

    Raises:
        NoDisplay: There is no screen to open a window on.
    """

    def __init__(self, title: str, *, without_display: bool = False) -> None:
        open_video(without_display=without_display)
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


def open_video(*, without_display: bool = False) -> None:
    """Start SDL's video.

    Raises:
        NoDisplay: SDL finds no screen, or was told to use a driver that shows nothing.
    """
    os.environ.setdefault("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")  # real pixels on Windows
    os.environ.setdefault("SDL_VIDEO_X11_WMCLASS", "Silverball")  # what a desktop lists it under
    if sys.platform == "linux" and not {"XDG_RUNTIME_DIR", "WAYLAND_DISPLAY"} & os.environ.keys():
        # Wayland cannot work without these; asked nevertheless, its library prints an error of its own.
        os.environ.setdefault("SDL_VIDEODRIVER", "x11,kmsdrm")
    try:
        pygame.display.init()
    except pygame.error as error:
        raise NoDisplay(_sentence(f"SDL says: {error}")) from None
    driver = pygame.display.get_driver()
    if driver.lower() in _NOT_A_SCREEN and not without_display:
        pygame.display.quit()
        raise NoDisplay(_sentence(f"SDL uses the driver {driver!r}, which shows nothing"))
    if driver == "x11" and not has_gpu():
        # SDL would put each frame through OpenGL, which without a GPU takes 4 ms instead of 0.3 ms.
        os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")
    else:
        os.environ.setdefault("SDL_RENDER_VSYNC", "1")  # a flip waits for the screen: no picture is torn


def has_gpu() -> bool:
    """Whether Linux knows of a graphics card; elsewhere it is taken for granted."""
    return sys.platform != "linux" or any(Path("/dev/dri").glob("renderD*"))


def _sentence(reason: str) -> str:
    return (
        f"there is no display to open a window on ({reason}); "
        "`silverball demo` makes a film of a game without one, for example: silverball demo --out demo.gif"
    )
