"""Is the mouse pointer seen? Only while it moves and for two seconds after, for nothing here needs it.

It is also shown when a game is paused and while the window has no focus: then somebody looks for it.
"""

from __future__ import annotations

import pygame

REST = 2.0  # [s] without a move, after which it is hidden
_TOUCHED = (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEWHEEL)


class Pointer:
    """The mouse pointer over the window."""

    def __init__(self) -> None:
        self._rests = 0.0  # since when it has not been moved [s]
        self._is_elsewhere = False  # another window has the focus
        self._waited = False

    def answer(self, event: pygame.Event) -> None:
        """Take note of a move, and of the focus that comes and goes."""
        if event.type in _TOUCHED:
            if getattr(event, "rel", None) != (0, 0):  # as comes with a window that opens under it
                self._show()
        elif event.type in (pygame.WINDOWFOCUSLOST, pygame.WINDOWFOCUSGAINED):
            self._is_elsewhere = event.type == pygame.WINDOWFOCUSLOST
            self._show()

    def pass_time(self, elapsed: float, *, waits: bool) -> None:
        """Let real time pass.

        Args:
            elapsed: How much [s].
            waits: Whether a game waits for its player.
        """
        if waits and not self._waited:
            self._show()
        self._waited = waits
        self._rests += elapsed
        if self._rests >= REST and not self._is_elsewhere and pygame.mouse.get_visible():
            pygame.mouse.set_visible(False)

    def _show(self) -> None:
        self._rests = 0.0
        pygame.mouse.set_visible(True)
