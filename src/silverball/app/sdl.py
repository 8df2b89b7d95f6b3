"""Functions of SDL that pygame does not expose: the keyboard layout, and the arrangement of the screens.

They call the library that pygame has loaded. If it cannot be found they return None, and callers fall back to
pygame.
"""

from __future__ import annotations

import ctypes
import sys
from functools import lru_cache
from typing import Any

import pygame


class _Rect(ctypes.Structure):
    _fields_ = (("x", ctypes.c_int), ("y", ctypes.c_int), ("w", ctypes.c_int), ("h", ctypes.c_int))


def keycode_at(scancode: int) -> int | None:
    """Return the key code of a scancode on the current layout; 0 if it has none."""
    function = _function("SDL_GetKeyFromScancode")
    return None if function is None else int(function(scancode))


def display_index(window: int) -> int | None:
    """Return the index of the screen on which most of a window is.

    Args:
        window: Its `pygame.Window.id`.
    """
    find_window, find_display = _function("SDL_GetWindowFromID"), _function("SDL_GetWindowDisplayIndex")
    if find_window is None or find_display is None:
        return None
    find_window.restype, find_display.argtypes = ctypes.c_void_p, (ctypes.c_void_p,)
    screen = int(find_display(find_window(window)))
    return screen if screen >= 0 else None


def display_bounds(screen: int) -> pygame.Rect | None:
    """Return the position and size of a screen on the desktop."""
    return _area("SDL_GetDisplayBounds", screen)


def screens() -> list[pygame.Rect]:
    """Return position and size of all screens on the desktop; side by side if the library is not found."""
    sizes = pygame.display.get_desktop_sizes()
    found = [display_bounds(screen) for screen in range(len(sizes))]
    lefts = [sum(width for width, _ in sizes[:number]) for number in range(len(sizes))]
    return [
        area or pygame.Rect((left, 0), size) for area, left, size in zip(found, lefts, sizes, strict=True)
    ]


def usable_bounds(screen: int) -> pygame.Rect | None:
    """Return the part of a screen without task bar, dock and menu bar."""
    return _area("SDL_GetDisplayUsableBounds", screen)


def _area(name: str, screen: int) -> pygame.Rect | None:
    function, found = _function(name), _Rect()
    if function is None or function(screen, ctypes.byref(found)) != 0:
        return None
    return pygame.Rect(found.x, found.y, found.w, found.h)


def _function(name: str) -> Any:
    """Return a function of SDL 2; None if it is missing."""
    return getattr(_library(), name, None)


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL | None:
    if pygame.get_sdl_version()[0] != 2:  # SDL 3 has other signatures
        return None
    # Windows finds a loaded library by its name; elsewhere pygame's own module leads to it.
    name = "SDL2.dll" if sys.platform == "win32" else str(pygame.base.__file__)
    try:
        return ctypes.CDLL(name)
    except OSError:
        return None
