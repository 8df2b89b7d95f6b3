"""A window on SDL's dummy driver, moved frame by frame, with keys that come through SDL's own queue."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pygame
import pytest

from silverball.app.window import Window
from silverball.drawing.compiling import is_compiled

FRAME = 1 / 60  # [s]


class Player:
    """Somebody at the keyboard of a window."""

    def __init__(self, window: Window) -> None:
        self.window = window

    @property
    def world(self):
        return self.window.session.world

    def press(self, key: int, mod: int = 0) -> None:
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=key, mod=mod, unicode="", scancode=0))

    def release(self, key: int) -> None:
        pygame.event.post(pygame.Event(pygame.KEYUP, key=key, mod=0, unicode="", scancode=0))

    def tap(self, key: int, mod: int = 0) -> None:
        """Press and release within one frame."""
        self.press(key, mod)
        self.release(key)
        self.frames(1)

    def frames(self, count: int, elapsed: float = FRAME) -> None:
        for _ in range(count):
            self.window.frame(elapsed)

    def seconds(self, seconds: float) -> None:
        self.frames(round(seconds / FRAME))

    @property
    def says(self) -> str:
        return self.window.messages.text if self.window.messages.strength > 0 else ""


@pytest.fixture(autouse=True)
def without_screen(monkeypatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


@pytest.fixture
def open_window(tmp_path) -> Iterator:
    opened = []

    def opener(table="classic", seed=7, **options) -> Player:
        options.setdefault("data_folder", tmp_path / "data")
        window = Window(table, seed, height=400, without_display=True, **options)
        opened.append(window)
        limit = time.monotonic() + 60.0
        while not window.is_ready:
            assert time.monotonic() < limit, "the physics was not ready within a minute"
            window.frame(0.0)
            time.sleep(0.002)
        if is_compiled():  # else the sketch stays; a picture that changes by itself would confuse the tests
            window._picture.renderer.wait(60.0)
        pygame.event.clear()
        return Player(window)

    yield opener
    for window in opened:
        window.close()


@pytest.fixture
def player(open_window) -> Player:
    return open_window()
