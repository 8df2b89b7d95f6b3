"""The window of the operating system: how is it opened, how large is it, and is there a display at all?

A pixel here is a real pixel of the screen: nothing is scaled, so it is sharp on high-density screens too.
"""

from __future__ import annotations

import pygame

from silverball.app import sdl
from silverball.app.pointer import Pointer
from silverball.drawing.sketch import ball_icon
from silverball.video_driver import open_video

DECORATION = 88  # [pixel] of a screen's height that title bar and task bar may take
TITLE_BAR = 48  # [pixel] of it that the title bar alone may take
FRAME = 8  # [pixel] that a frame may add on both sides
GREATEST_HEIGHT = 1200  # [pixel] of the window at first
ICON_SIDE = 64  # [pixel]
LEAST_SIZE = (170, 340)  # [pixel] below which nothing can be read
REMEDY = "`silverball demo` makes a film of a game without one, for example: silverball demo --out demo.gif"
FRAME_RATES = (60, 240)  # [1/s] the least and the greatest that is aimed at, whatever the screen says
_TYPING_ENDS = (pygame.WINDOWSHOWN, pygame.WINDOWSIZECHANGED, pygame.WINDOWFOCUSGAINED)


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
        self._pointer = Pointer()
        self.is_full = False

    @property
    def first_room(self) -> tuple[int, int]:
        """Width and height [pixel] within which a whole window, its decorations included, fits the screen."""
        width, height = self.desktop
        room = [width - 2 * FRAME, height - DECORATION]
        usable, area = sdl.usable_area(0), sdl.screen_area(0)
        if usable is not None and area is not None and area.size == self.desktop:
            room = [min(room[0], usable.width - 2 * FRAME), min(room[1], usable.height - TITLE_BAR)]
        return max(room[0], 1), min(max(room[1], 1), GREATEST_HEIGHT)

    @property
    def first_height(self) -> int:
        """The height [pixel] at which the whole window, its decorations included, fits the screen."""
        return self.first_room[1]

    @property
    def refresh_rate(self) -> int:
        """Pictures per second that the screen shows on which the window stands, as far as it says."""
        rates = pygame.display.get_desktop_refresh_rates()
        number = self._number()
        return min(max(rates[number] if number < len(rates) else 0, FRAME_RATES[0]), FRAME_RATES[1])

    @property
    def surface(self) -> pygame.Surface:
        """What the window shows after the next `flip`, at its present size."""
        return self._opened.get_surface()

    def open(self, size: tuple[int, int]) -> None:
        """Show the window at a size."""
        self._window = pygame.Window(self._title, size, resizable=True, allow_high_dpi=True)
        self._window.minimum_size = min(LEAST_SIZE[0], size[0]), min(LEAST_SIZE[1], size[1])
        self._window.set_icon(ball_icon(ICON_SIDE))
        _hear_keys_alone()

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
        _hear_keys_alone()

    def resize(self, size: tuple[int, int]) -> None:
        """Make the window another size."""
        self._opened.size = size
        _hear_keys_alone()

    def answer(self, event: pygame.Event) -> None:
        """Follow the pointer, and what the desktop does with the window."""
        self._pointer.answer(event)
        if event.type in _TYPING_ENDS:
            _hear_keys_alone()

    def pass_time(self, elapsed: float, *, waits: bool) -> None:
        """Real time has gone on [s], while a game waits for its player or not."""
        self._pointer.pass_time(elapsed, waits=waits)

    def close(self) -> None:
        """Close the window."""
        if self._window is not None:
            self._window.destroy()
            self._window = None
        pygame.display.quit()

    def _number(self) -> int:
        """On which screen the window stands, counted from 0; before it opens, the first."""
        if self._window is None:
            return 0
        sizes = pygame.display.get_desktop_sizes()
        number = sdl.screen_of(self._window.id)
        if number is not None and all(sdl.screen_area(screen) for screen in range(len(sizes))):
            return number
        # Nobody says where the screens stand: side by side, then, the first one on the left.
        middle, left = self._window.position[0] + self._window.size[0] // 2, 0
        for number, (width, _) in enumerate(sizes):
            left += width
            if middle < left:
                return number
        return max(len(sizes) - 1, 0)

    @property
    def _opened(self) -> pygame.Window:
        assert self._window is not None, "open() comes first"
        return self._window


def _hear_keys_alone() -> None:
    """End the typing of text with which SDL begins: an input method that composes would keep letters."""
    pygame.key.stop_text_input()
