"""Hands at a window that a private X server shows: real keys and a real mouse, in the time of the game.

The X server makes the events (XTest), as for a person; SDL passes them on. The time of the game goes on only
when the hands let it, by frames and ticks of exact length, so that a game under them is the same on every
machine.
"""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pygame
import pytest
from comet_games import inputs_of, skip
from xserver import x_server

from patience import PATIENCE
from silverball.app.window import Window
from silverball.game.replay.format import Replay
from silverball.game.replay.recording import BALL, LAUNCH, LEFT, NUDGES, RIGHT
from silverball.game.view import Phase

TICK = 1.0 / 240.0  # [s]
KEYS = {LEFT: "a", RIGHT: "d", LAUNCH: "space", NUDGES["left"]: "z", NUDGES["right"]: "x", NUDGES["up"]: "Up"}
"""The key of each input of a replay."""


class XTest:
    """What presses keys and moves the mouse of an X server."""

    def __init__(self, display: str) -> None:
        self._x = ctypes.CDLL("libX11.so.6")
        self._test = ctypes.CDLL("libXtst.so.6")
        self._x.XOpenDisplay.restype = ctypes.c_void_p
        self._x.XStringToKeysym.restype = ctypes.c_ulong
        self._x.XKeysymToKeycode.argtypes = (ctypes.c_void_p, ctypes.c_ulong)
        self._x.XSync.argtypes = (ctypes.c_void_p, ctypes.c_int)
        self._x.XCloseDisplay.argtypes = (ctypes.c_void_p,)
        for name in ("XTestFakeKeyEvent", "XTestFakeButtonEvent"):
            getattr(self._test, name).argtypes = (
                ctypes.c_void_p,
                ctypes.c_uint,
                ctypes.c_int,
                ctypes.c_ulong,
            )
        self._test.XTestFakeMotionEvent.argtypes = (
            ctypes.c_void_p, ctypes.c_int, ctypes.c_int, ctypes.c_int, ctypes.c_ulong,
        )  # fmt: skip
        self._display = self._x.XOpenDisplay(display.encode())
        assert self._display, f"{display} does not answer"

    def key(self, name: str, is_down: bool) -> None:
        """A key by the name of X ("a", "space", "Return") goes down or comes up."""
        code = self._x.XKeysymToKeycode(self._display, self._x.XStringToKeysym(name.encode()))
        assert code, f"there is no key {name}"
        self._test.XTestFakeKeyEvent(self._display, code, is_down, 0)
        self._x.XSync(self._display, 0)

    def button(self, number: int, is_down: bool) -> None:
        """A button of the mouse: 1 left, 3 right, 4 and 5 the wheel."""
        self._test.XTestFakeButtonEvent(self._display, number, is_down, 0)
        self._x.XSync(self._display, 0)

    def move(self, x: int, y: int) -> None:
        """The mouse moves to a pixel of the screen."""
        self._test.XTestFakeMotionEvent(self._display, -1, x, y, 0)
        self._x.XSync(self._display, 0)

    def close(self) -> None:
        self._x.XCloseDisplay(self._display)


class Hands:
    """Somebody at the keyboard and the mouse of a window.

    Args:
        window: The window.
        display: The X server that shows it.

    Attributes:
        said: What the display has announced and the window has said, in order.
    """

    def __init__(self, window: Window, display: str) -> None:
        self.window, self.display = window, display
        self.said: list[str] = []
        self._x = XTest(display)
        self._pointer = (-1, -1)  # where the mouse is
        self._seen: list[tuple[int, int]] = []  # the events that have come: type, and key or button
        real = window.input_handler.handle

        def handle(event: pygame.Event) -> None:
            self._seen.append((event.type, getattr(event, "key", getattr(event, "button", 0))))
            real(event)

        window.input_handler.handle = handle  # type: ignore[method-assign]

    def close(self) -> None:
        self.window.close()
        self._x.close()

    # --- what is on the screen

    @property
    def program(self):
        return self.window.program

    @property
    def menus(self):
        return self.window.program.menus

    @property
    def game(self):
        return self.window.program.session.game

    @property
    def labels(self) -> list[str]:
        """The rows of the page that is open."""
        return [row.label for row in self.menus.listing.rows]

    def pixels(self, around: tuple[float, float] | None = None, radius: int = 4):
        """The window's pixels, or those around a place of the table [u]."""
        screen = pygame.surfarray.array3d(self.window._screen.surface).astype(int)
        if around is None:
            return screen
        picture = self.window._picture
        column, row = picture.renderer.camera.to_pixel(*around)
        x, y = round(picture.area.left + column), round(picture.area.top + row)
        return screen[x - radius : x + radius + 1, y - radius : y + radius + 1]

    # --- time

    def frames(self, count: int = 1, elapsed: float = 1.0 / 60.0) -> None:
        """Draw and show so many frames."""
        for _ in range(count):
            self.window.frame(elapsed)
            self._listen()

    def seconds(self, seconds: float) -> None:
        """Time passes, 30 frames a second."""
        self.frames(round(seconds * 30), 1.0 / 30.0)

    def until(self, is_reached: Callable[[], bool], seconds: float = 60.0) -> None:
        """Time passes until something is reached, within so many seconds of play; 7 frames a second."""
        for poll in range(round(seconds * 20)):
            if is_reached():
                return
            self.window.poll_input(1.0 / 20.0)
            if poll % 3 == 0:
                self.frames(1, 0.0)
        raise AssertionError(f"not reached within {seconds} s of play")

    def ticks_to(self, tick: int, drawn_every: int = 8) -> None:
        """The game goes on to a tick, drawn 30 times a second."""
        while self.game.tick < tick and not self.game.is_over:
            self.window.poll_input(TICK)
            if self.game.tick % drawn_every == 0:
                self.window.draw()
                self.window.show()
                self._listen()

    def _listen(self) -> None:
        current = self.program.display._announcements.current
        for text in (current.text if current is not None else "", self.window.messages.text):
            if text and text not in self.said[-2:]:
                self.said.append(text)

    # --- keys and mouse

    def _wait(self, event: int, what: int, send: Callable[[], None]) -> None:
        """Do something, and wait until the window has been told."""
        self._seen.clear()
        send()
        limit = time.monotonic() + PATIENCE
        while (event, what) not in self._seen:
            assert time.monotonic() < limit, f"no event {pygame.event.event_name(event)} {what}"
            self.window.poll_input(0.0)

    def press(self, name: str) -> None:
        self._wait(pygame.KEYDOWN, _sdl_key(name), lambda: self._x.key(name, True))

    def release(self, name: str) -> None:
        self._wait(pygame.KEYUP, _sdl_key(name), lambda: self._x.key(name, False))

    def tap(self, *names: str) -> None:
        """Press and release keys one after the other, a frame each."""
        for name in names:
            self.press(name)
            self.frames(1)
            self.release(name)
            self.frames(1)

    def point(self, row: int) -> None:
        """Point at a row of the list."""
        cell = next(cell for cell in self.window._backglass.list_view._cells if cell.row == row)
        x, y = self.window._screen._window.position
        place = x + cell.area.centerx, y + cell.area.centery
        if place != self._pointer:
            self._wait(pygame.MOUSEMOTION, 0, lambda: self._x.move(*place))
            self._pointer = place
        self.frames(1)

    def click(self, label: str) -> None:
        """Point at a row of the list and click on it."""
        self.point(next(index for index, row in enumerate(self.labels) if row.startswith(label)))
        self._wait(pygame.MOUSEBUTTONDOWN, 1, lambda: self._x.button(1, True))
        self._wait(pygame.MOUSEBUTTONUP, 1, lambda: self._x.button(1, False))
        self.frames(1)

    # --- a game that was found before

    def skip(self, replay: Replay, tick: int) -> None:
        """Play on to a tick of a replay at once, without hands: the inputs go to the window's own game.

        The buttons that are held there are then pressed.
        """
        self.let_go()
        held = skip(self.program.session, replay, tick)
        game = self.game
        game.take_game_events()
        game.take_world_events()
        self.window.poll_input(0.0)
        for kind, is_down in held.items():
            if is_down:
                self.press(KEYS[kind])

    def follow(self, replay: Replay, tick: int) -> None:
        """Press the keys of a replay at its ticks, from now on to a tick."""
        for at, kind in inputs_of(replay):
            if self.game.tick <= at < tick:
                self.ticks_to(at)
                self._do(kind)
        self.ticks_to(tick)

    def _do(self, kind: str) -> None:
        if kind == BALL:
            if self.game.phase is Phase.READY:  # the first one has come by itself
                self.press("space")
                self.release("space")
            return
        key = KEYS[kind]
        is_down = kind in NUDGES.values() or not self._is_held(kind)
        (self.press if is_down else self.release)(key)
        if kind in NUDGES.values():
            self.release(key)

    def _is_held(self, kind: str) -> bool:
        keys = pygame.key.get_pressed()
        return bool(keys[_sdl_key(KEYS[kind])])

    def launch(self, seconds: float = 0.5) -> None:
        """Bring a ball if there is none, draw the plunger back, and let go."""
        if self.game.phase is Phase.READY:
            self.tap("space")
        self.press("space")
        self.seconds(seconds)
        self.release("space")
        self.frames(2)

    def drain(self, balls: int = 20) -> None:
        """Play on without a hand at the paddles until the game is over."""
        for _ in range(balls):
            if self.game.is_over:
                return
            if self.game.phase is Phase.READY or self.game.has_ball_to_launch:
                self.launch()
            self.until(lambda: self.game.phase is not Phase.PLAY or self.game.has_ball_to_launch, 200.0)
        raise AssertionError("the game does not end")

    def let_go(self) -> None:
        """Release all keys of the game."""
        for kind in (LEFT, RIGHT, LAUNCH):
            if self._is_held(kind):
                self.release(KEYS[kind])


def _sdl_key(name: str) -> int:
    return pygame.key.key_code(name.lower())


@contextmanager
def at_window(folder: Path, screen: tuple[int, int] = (1024, 640), **options) -> Iterator[Hands]:
    """A window on an X server of its own, with an empty folder of scores, ready to play."""
    with x_server(*screen) as display, pytest.MonkeyPatch.context() as patch:
        patch.setenv("SDL_VIDEODRIVER", "x11")
        patch.setenv("SDL_AUDIODRIVER", "dummy")
        patch.setenv("DISPLAY", display)
        window = Window(folder=folder, **options)
        limit = time.monotonic() + 600.0
        while not (window.is_ready and window._screen._window.focused):
            assert time.monotonic() < limit, "the window is not ready"
            window.frame(0.0)
            time.sleep(0.02)
        hands = Hands(window, display)
        hands.frames(1, 0.0)
        try:
            yield hands
        finally:
            hands.close()


def lamp_center(table, name: str) -> tuple[float, float]:
    """Where a lamp is on the table [u]."""
    return next(lamp.center for lamp in table.lamp if lamp.name == name)
