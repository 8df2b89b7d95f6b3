"""A window on SDL's dummy driver, advanced frame by frame, with keys through SDL's own queue."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pygame
import pytest

from silverball.app.window import Window
from silverball.game.view import Mode
from silverball.table import Table

FRAME = 1 / 60  # [s]
SLOW_FRAME = 1 / 30  # [s] where many are needed


class Player:
    """Somebody at the keyboard of a window."""

    def __init__(self, window: Window) -> None:
        self.window = window

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
    def world(self):
        return self.game.world

    def press(self, key: int, mod: int = 0) -> None:
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=key, mod=mod, unicode="", scancode=0))

    def release(self, key: int) -> None:
        pygame.event.post(pygame.Event(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0))

    def tap(self, key: int, mod: int = 0) -> None:
        """Press and release within one frame."""
        self.press(key, mod)
        self.release(key)
        self.frames(1)

    def pad(self, button: int, down: bool = True) -> None:
        """A gamepad button goes down or comes up."""
        kind = pygame.CONTROLLERBUTTONDOWN if down else pygame.CONTROLLERBUTTONUP
        pygame.event.post(pygame.Event(kind, instance_id=0, button=button))

    def tap_pad(self, button: int) -> None:
        self.pad(button)
        self.pad(button, down=False)
        self.frames(1)

    def frames(self, count: int, elapsed: float = FRAME) -> None:
        for _ in range(count):
            self.window.frame(elapsed)

    def seconds(self, seconds: float) -> None:
        self.frames(round(seconds / SLOW_FRAME), SLOW_FRAME)

    def until(self, is_reached, seconds: float = 60.0) -> None:
        """Frames until something is reached, within so many seconds of play."""
        for _ in range(round(seconds / SLOW_FRAME)):
            if is_reached():
                return
            self.frames(1, SLOW_FRAME)
        raise AssertionError(f"not reached within {seconds} s of play")

    @property
    def says(self) -> str:
        return self.window.messages.text if self.window.messages.opacity > 0 else ""


@pytest.fixture(autouse=True)
def without_screen(monkeypatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")


@pytest.fixture(autouse=True)
def sketches(request, monkeypatch) -> None:
    """Only tests marked `sharp` wait for pictures in full quality; the others always see the sketch."""
    if "sharp" not in request.keywords:
        monkeypatch.setattr("silverball.drawing.renderer.load_baked_table", lambda cache, key: None)
        monkeypatch.setattr("silverball.drawing.background.Background._work", lambda self: None)


@pytest.fixture(autouse=True)
def no_player_warmup(request, monkeypatch) -> None:
    """Only tests marked `rehearsed` wait for players that need compiled code of their own."""
    if "rehearsed" not in request.keywords:
        monkeypatch.setattr("silverball.app.player_warmup.PlayerWarmup._work", lambda self: None)


@pytest.fixture
def open_window(tmp_path) -> Iterator:
    opened = []

    def opener(table: Table | str | None = "classic", seed: int | None = 7, **options) -> Player:
        options.setdefault("folder", tmp_path / "data")
        options.setdefault("mode", Mode.FREE)
        window = Window(table, seed, height=400, without_display=True, **options)
        opened.append(window)
        limit = time.monotonic() + 300.0
        while not window.is_ready:
            assert time.monotonic() < limit, "the physics was not ready within five minutes"
            window.frame(0.0)
            time.sleep(0.05)  # the compiler needs the processor more
        pygame.event.clear()
        window.frame(0.0)
        return Player(window)

    yield opener
    for window in opened:
        window.close()


@pytest.fixture
def player(open_window) -> Player:
    return open_window()
