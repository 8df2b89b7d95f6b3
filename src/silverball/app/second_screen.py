"""The window of a cabinet's backglass: without a frame, it fills another screen than that of the table."""

from __future__ import annotations

import pygame

from silverball.app import sdl


class SecondScreen:
    """The window on the second screen.

    Args:
        title: Title of the window.
        area: Where that screen is on the desktop.
    """

    def __init__(self, title: str, area: pygame.Rect) -> None:
        self._window = pygame.Window(title, area.size, area.topleft, borderless=True, allow_high_dpi=True)

    @property
    def surface(self) -> pygame.Surface:
        """The surface that the next `flip` shows."""
        return self._window.get_surface()

    @property
    def window(self) -> pygame.Window:
        """The window."""
        return self._window

    def flip(self) -> None:
        """Show what was drawn."""
        self._window.flip()

    def close(self) -> None:
        """Close the window."""
        self._window.destroy()


def other_screen(index: int) -> pygame.Rect | None:
    """Return where the first screen is that is not the one with an index; None if there is no other."""
    return next((area for number, area in enumerate(sdl.screens()) if number != index), None)
