"""What does SDL know that pygame does not pass on? What each key bears, and where the screens stand.

The functions are SDL's own, called in the library that pygame has loaded. Where that cannot be reached they
answer None, and whoever asks makes do with what pygame says.
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
    """What the key at a place bears on the present layout, as pygame's number; 0 if nothing."""
    function = _function("SDL_GetKeyFromScancode")
    return None if function is None else int(function(scancode))


def display_index(window: int) -> int | None:
    """On which screen, counted from 0, most of a window stands.

    Args:
        window: Its number, `pygame.Window.id`.
    """
    find, ask = _function("SDL_GetWindowFromID"), _function("SDL_GetWindowDisplayIndex")
    if find is None or ask is None:
        return None
    find.restype, ask.argtypes = ctypes.c_void_p, (ctypes.c_void_p,)
    screen = int(ask(find(window)))
    return screen if screen >= 0 else None


def display_bounds(screen: int) -> pygame.Rect | None:
    """Where a screen stands among the others, and how large it is."""
    return _area("SDL_GetDisplayBounds", screen)


def usable_bounds(screen: int) -> pygame.Rect | None:
    """The part of a screen that no task bar, dock or menu bar takes."""
    return _area("SDL_GetDisplayUsableBounds", screen)


def _area(name: str, screen: int) -> pygame.Rect | None:
    function, found = _function(name), _Rect()
    if function is None or function(screen, ctypes.byref(found)) != 0:
        return None
    return pygame.Rect(found.x, found.y, found.w, found.h)


def _function(name: str) -> Any:
    """A function of SDL 2; None if there is none."""
    return getattr(_library(), name, None)


@lru_cache(maxsize=1)
def _library() -> ctypes.CDLL | None:
    if pygame.get_sdl_version()[0] != 2:  # the functions of SDL 3 take other arguments
        return None
    # Windows knows a loaded library by its name; elsewhere pygame's module leads to what it is linked with.
    name = "SDL2.dll" if sys.platform == "win32" else str(pygame.base.__file__)
    try:
        return ctypes.CDLL(name)
    except OSError:
        return None
