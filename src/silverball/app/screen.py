"""The window of the operating system, its size, and the mouse pointer over it; in a cabinet, two windows.

Pixels are physical pixels of the screen: nothing is scaled, so pictures are sharp on high-density screens.
"""

from __future__ import annotations

import pygame

from silverball.app import sdl
from silverball.app.cabinet_mode import CabinetMode
from silverball.app.second_screen import SecondScreen, other_screen
from silverball.app.turned_picture import TurnedPicture
from silverball.drawing.sketch import ball_icon
from silverball.video_driver import open_video

DECORATION = 88  # [pixel] height of title bar and task bar together
TITLE_BAR = 48  # [pixel] height of the title bar alone
FRAME = 8  # [pixel] that the window frame may add on each side
MAX_HEIGHT = 1200  # [pixel] of the window when it opens
ICON_SIDE = 64  # [pixel]
MIN_SIZE = (170, 340)  # [pixel] below which text is unreadable
REMEDY = "`silverball demo` films a game without one, for example: silverball demo --out demo.gif"
FRAME_RATES = (60, 240)  # [1/s] the smallest and the greatest target
_TEXT_INPUT_STARTS = (pygame.WINDOWSHOWN, pygame.WINDOWSIZECHANGED, pygame.WINDOWFOCUSGAINED)


class Screen:
    """The window of the operating system.

    Args:
        title: Title of the window.
        cabinet: How the picture stands on the screen.
        without_display: Whether SDL drivers without output are accepted, as in tests.

    Attributes:
        cabinet: How the picture stands on the screen.
        second: The window of the backglass on a screen of its own; None without one.

    Raises:
        NoDisplay: There is no display.
    """

    def __init__(
        self, title: str, cabinet: CabinetMode = CabinetMode.OFF, *, without_display: bool = False
    ) -> None:
        open_video(REMEDY, without_display=without_display)
        self.desktop: tuple[int, int] = pygame.display.get_desktop_sizes()[0]
        self._title = title
        self._window: pygame.Window | None = None
        self._pointer = Pointer()
        self._turned = TurnedPicture()
        self.cabinet = cabinet
        self.second: SecondScreen | None = None
        self.is_fullscreen = False

    @property
    def max_initial_size(self) -> tuple[int, int]:
        """Width and height [pixel] of the picture up to which its window fits the screen with decorations."""
        width, height = self.desktop
        size = [width - 2 * FRAME, height - DECORATION]
        usable, area = sdl.usable_bounds(0), sdl.display_bounds(0)
        if usable is not None and area is not None and area.size == self.desktop:
            size = [min(size[0], usable.width - 2 * FRAME), min(size[1], usable.height - TITLE_BAR)]
        if self.cabinet.is_turned:
            return max(size[1], 1), max(size[0], 1)
        return max(size[0], 1), min(max(size[1], 1), MAX_HEIGHT)

    @property
    def refresh_rate(self) -> int:
        """The refresh rate [1/s] of the screen on which the window is, within `FRAME_RATES`."""
        rates = pygame.display.get_desktop_refresh_rates()
        number = self._display_index()
        return min(max(rates[number] if number < len(rates) else 0, FRAME_RATES[0]), FRAME_RATES[1])

    @property
    def surface(self) -> pygame.Surface:
        """The upright surface that the next `flip` shows, in the current size of the window."""
        window = self._opened.get_surface()
        return self._turned.upright(window) if self.cabinet.is_turned else window

    @property
    def second_size(self) -> tuple[int, int] | None:
        """Width and height of the backglass on a screen of its own [pixel]; None without one."""
        return None if self.second is None else self.second.surface.get_size()

    def open(self, picture_size: tuple[int, int]) -> None:
        """Open the window for a picture of a size [pixel], and in a cabinet the one of the backglass."""
        size = self.cabinet.turned(picture_size)
        self._window = pygame.Window(self._title, size, resizable=True, allow_high_dpi=True)
        self._window.minimum_size = min(MIN_SIZE[0], size[0]), min(MIN_SIZE[1], size[1])
        self._window.set_icon(ball_icon(ICON_SIDE))
        self._open_second()
        _disable_text_input()

    def change_cabinet(self, cabinet: CabinetMode) -> None:
        """Let the picture stand otherwise on the screen; the window keeps its size."""
        self.cabinet = cabinet
        self._open_second()

    def _open_second(self) -> None:
        """Open the window of the backglass in a cabinet with a second screen; close it otherwise."""
        area = None if self.cabinet is CabinetMode.OFF else other_screen(self._display_index())
        if area is None and self.second is not None:
            self.second.close()
            self.second = None
        elif area is not None and self.second is None:
            self.second = SecondScreen(f"{self._title}: backglass", area)
            self._opened.focus()  # the keys belong to the table

    def owns(self, event: pygame.Event) -> bool:
        """Return whether an event belongs to this window, and not to another one of this process."""
        return getattr(event, "window", self._window) is self._window

    def has_lost_focus(self, event: pygame.Event) -> bool:
        """Return whether an event says that the keys have gone to another program.

        Between the window of the table and that of the backglass they may wander: both belong to the game.
        """
        if event.type != pygame.WINDOWFOCUSLOST:
            return False
        if self.second is None or not hasattr(event, "window"):
            return self.owns(event)
        return not pygame.key.get_focused()

    def to_backglass(self, event: pygame.Event) -> tuple[int, int] | None:
        """Return where the mouse is on the surface with the backglass [pixel]; None on the other window.

        SDL tells it in units that may be larger than pixels.
        """
        window = self._opened if self.second is None else self.second.window
        if getattr(event, "window", window) is not window:
            return None
        size, units = window.get_surface().get_size(), window.size
        x = event.pos[0] * size[0] // max(units[0], 1)
        y = event.pos[1] * size[1] // max(units[1], 1)
        return (x, y) if self.second is not None else self.cabinet.to_upright((x, y), size)

    def flip(self) -> None:
        """Show what was drawn."""
        if self.cabinet.is_turned:
            self._turned.copy_to(self._opened.get_surface(), self.cabinet)
        self._opened.flip()
        if self.second is not None:
            self.second.flip()

    def toggle_fullscreen(self) -> None:
        """Switch between full screen and window."""
        self.is_fullscreen = not self.is_fullscreen
        if self.is_fullscreen:
            self._opened.set_fullscreen(desktop=True)
        else:
            self._opened.set_windowed()
        _disable_text_input()

    def resize(self, picture_size: tuple[int, int]) -> None:
        """Resize the window for a picture of another size [pixel]."""
        self._opened.size = self.cabinet.turned(picture_size)
        _disable_text_input()

    def handle(self, event: pygame.Event) -> None:
        """Handle an event of the pointer or of the desktop."""
        self._pointer.handle(event)
        if event.type in _TEXT_INPUT_STARTS:
            _disable_text_input()

    def update(self, elapsed: float, *, is_paused: bool) -> None:
        """Advance by real time [s]; the pointer is visible while a game is paused."""
        self._pointer.update(elapsed, is_paused=is_paused)

    def close(self) -> None:
        """Close the windows."""
        if self.second is not None:
            self.second.close()
            self.second = None
        if self._window is not None:
            self._window.destroy()
            self._window = None
        pygame.display.quit()

    def _display_index(self) -> int:
        """The index of the screen on which the window is; 0 before it opens."""
        if self._window is None:
            return 0
        sizes = pygame.display.get_desktop_sizes()
        number = sdl.display_index(self._window.id)
        if number is not None and all(sdl.display_bounds(screen) for screen in range(len(sizes))):
            return number
        # The arrangement of the screens is unknown: assume side by side, the first one on the left.
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


def _disable_text_input() -> None:
    """Stop the text input that SDL starts: an input method would swallow letters."""
    pygame.key.stop_text_input()


HIDE_AFTER = 2.0  # [s] without motion
_POINTER_EVENTS = (pygame.MOUSEMOTION, pygame.MOUSEBUTTONDOWN, pygame.MOUSEWHEEL)


class Pointer:
    """The mouse pointer: visible while it moves, and when a game is paused or the window has no focus."""

    def __init__(self) -> None:
        self._still_time = 0.0  # since the last motion [s]
        self._has_focus = True
        self._was_paused = False

    def handle(self, event: pygame.Event) -> None:
        """Handle motion, and changes of the focus."""
        if event.type in _POINTER_EVENTS:
            if getattr(event, "rel", None) != (0, 0):  # no motion: a window has opened under the pointer
                self._show()
        elif event.type in (pygame.WINDOWFOCUSLOST, pygame.WINDOWFOCUSGAINED):
            self._has_focus = event.type == pygame.WINDOWFOCUSGAINED
            self._show()

    def update(self, elapsed: float, *, is_paused: bool) -> None:
        """Advance by real time [s]; the pointer is visible while a game is paused."""
        if is_paused and not self._was_paused:
            self._show()
        self._was_paused = is_paused
        self._still_time += elapsed
        if self._still_time >= HIDE_AFTER and self._has_focus and pygame.mouse.get_visible():
            pygame.mouse.set_visible(False)

    def _show(self) -> None:
        self._still_time = 0.0
        pygame.mouse.set_visible(True)
