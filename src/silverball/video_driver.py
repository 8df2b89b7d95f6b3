"""Starting SDL's video, or saying why there is no display; for windows of games and environments."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pygame

from silverball.errors import NoDisplay

NOT_A_SCREEN = ("dummy", "offscreen", "evdev")
"""SDL drivers that show nothing."""


def open_video(remedy: str, *, without_display: bool = False) -> None:
    """Start SDL's video.

    Args:
        remedy: What to do instead if there is no display, as a sentence.
        without_display: Whether SDL drivers that show nothing are accepted.

    Raises:
        NoDisplay: SDL finds no screen, or is configured to use a driver that shows nothing.
    """
    os.environ.setdefault("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")  # real pixels on Windows
    os.environ.setdefault("SDL_VIDEO_X11_WMCLASS", "Silverball")  # its name on a desktop
    if sys.platform == "linux" and not {"XDG_RUNTIME_DIR", "WAYLAND_DISPLAY"} & os.environ.keys():
        # Without these Wayland cannot work, and its library would print an error of its own.
        os.environ.setdefault("SDL_VIDEODRIVER", "x11,kmsdrm")
    try:
        pygame.display.init()
    except pygame.error as error:
        raise NoDisplay(_sentence(f"SDL says: {error}", remedy)) from None
    driver = pygame.display.get_driver()
    if driver.lower() in NOT_A_SCREEN and not without_display:
        pygame.display.quit()
        raise NoDisplay(_sentence(f"SDL uses the driver {driver!r}, which shows nothing", remedy))
    if driver == "x11" and not has_gpu():
        # SDL would draw each frame with OpenGL, which without a GPU takes 4 ms instead of 0.3 ms.
        os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")
    else:
        os.environ.setdefault("SDL_RENDER_VSYNC", "1")  # a flip waits for the screen, so no frame is torn


def has_gpu() -> bool:
    """Return whether Linux has a graphics card; on other systems it is assumed."""
    return sys.platform != "linux" or any(Path("/dev/dri").glob("renderD*"))


def _sentence(reason: str, remedy: str) -> str:
    return f"there is no display to open a window on ({reason}); {remedy}"
