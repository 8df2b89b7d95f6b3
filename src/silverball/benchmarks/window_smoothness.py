"""Smoothness, input latency and start-up time of the window.

The real window is opened, and the reflex player plays two balls of free play, or arcade games with their
rules, lamps and music, with key events; or a player plays in attract mode, and its decisions are timed
instead of the latency. Scores go to a temporary folder.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from random import random
from typing import Any

import numpy as np

from silverball.benchmarks.speed import Figure

FRAME = 1 / 60  # [s]
PERCENTILES = (50, 90, 99, 99.9)
PULL_TIME = 0.8  # [s] for which the plunger is held
MIN_DECISION_TIME = 1e-4  # [s]; a shorter call only looks up the plan of the player
IMPORTED = time.time()


def measure_window(
    seconds: float,
    player: str | None,
    advance: Callable[[str], None] = lambda _: None,
    table: str = "random",
    size: tuple[int, int] | None = None,
    is_arcade: bool = False,
) -> list[Figure]:
    """Open the window, play, and measure.

    Args:
        seconds: Length of the measurement [s].
        player: Player to watch in attract mode; None to play with key events.
        advance: Called with the name of what is measured next.
        table: The table to play on.
        size: Width and height of the window [pixel]; None: as it opens.
        is_arcade: Whether arcade games are played instead of free play.
    """
    import pygame

    from silverball.app.window import Window
    from silverball.game.view import Mode
    from silverball.players import make_player

    advance("starting")
    with tempfile.TemporaryDirectory() as folder:
        mode = Mode.ARCADE if is_arcade else Mode.FREE
        window = Window(table, seed=7, mode=None if player else mode, size=size, folder=Path(folder))
        window.frame(0.0)
        first_picture = seconds_since_python_started()
        while not window.is_ready:
            window.frame(1 / 20)
            time.sleep(1 / 20)
        window.frame(FRAME)
        playable = seconds_since_python_started()
        driver: KeyDriver | AttractDriver
        driver = AttractDriver(player, window) if player else KeyDriver(make_player("reflex"), window)
        advance(f"playing {seconds:g} s")
        starts, work, processor = [], [], []
        sharp = 0.0
        end = time.perf_counter() + seconds
        before = time.perf_counter()
        while before < end:
            now, processor_start = time.perf_counter(), time.thread_time()
            due = now + FRAME
            before = window.render_frame(before)
            starts.append(now)
            work.append(time.perf_counter() - now)
            processor.append(time.thread_time() - processor_start)
            if not sharp and window.is_sharp:
                sharp = seconds_since_python_started()
            # A key is pressed at a random moment of the wait for the next picture.
            before = window.poll_until(time.perf_counter() + random() * (due - time.perf_counter()), before)
            driver.act()
            before = window.poll_until(due, before)
        figures = [
            Figure("start of Python to first picture", first_picture, "s"),
            Figure("start of Python to play", playable, "s"),
            *([Figure("start of Python to full quality", sharp, "s")] if sharp else []),
            Figure("width of the window", window.size[0], "pixels"),
            Figure("height of the window", window.size[1], "pixels"),
            Figure(f"frames, {pygame.display.get_driver()}", len(work) / seconds, "frames/s"),
            Figure("balls, mean", float(np.mean(driver.balls)), ""),
            *percentiles("work per frame", work),
            *percentiles("processor time per frame", processor),
            *percentiles("between frames", np.diff(starts)),
        ]
        if isinstance(driver, AttractDriver):
            figures += percentiles("a decision", driver.decisions)
            figures += percentiles("processor time of a decision", driver.processor)
        else:
            figures += percentiles("button to tick", window.latency.to_tick)
            figures += percentiles("button to picture", window.latency.to_picture)
        window.close()
    return figures


def seconds_since_python_started() -> float:
    """Wall time since this process started [s]; without /proc, since this module was imported."""
    try:
        ticks = int(Path("/proc/self/stat").read_text().rsplit(")", 1)[1].split()[19])
        uptime = float(Path("/proc/uptime").read_text().split()[0])
        return uptime - ticks / os.sysconf("SC_CLK_TCK")
    except OSError:
        return time.time() - IMPORTED


def percentiles(name: str, seconds: Iterable[float]) -> list[Figure]:
    """Percentiles and the maximum of some times; nothing if there are none."""
    values = np.array(list(seconds)) * 1e3
    if not values.size:
        return []
    found = [Figure(f"{name}, {p:g} %", float(np.percentile(values, p)), "ms") for p in PERCENTILES]
    return [*found, Figure(f"{name}, longest", float(values.max()), "ms")]


class KeyDriver:
    """Posts key events for the buttons that a player presses, and keeps balls on the board.

    In free play there are two balls; in an arcade game the next ball follows, and the next game.

    Args:
        player: A player for a single world.
        window: The open window, in a game.
    """

    def __init__(self, player: Any, window: Any) -> None:
        self._player, self._window = player, window
        self._down = [False, False]
        self._pulled = 0.0  # since when the plunger is held, by time.perf_counter; 0: it is not
        self.balls: list[int] = []
        player.press(window.program.session.game.world)  # load its kernel before the first frame

    def act(self) -> None:
        """Post the key events of all buttons that changed."""
        import pygame

        session = self._window.program.session
        if session is None or session.game.is_over:
            self._play_again()
            return
        world = session.game.world
        self.balls.append(len(world.balls))
        self._serve(session.game)
        for side, held in enumerate(self._player.press(world)):
            if held != self._down[side]:
                self._down[side] = held
                post_key((pygame.K_a, pygame.K_d)[side], held)

    def _serve(self, game: Any) -> None:
        """Start a ball where one is missing, and let go of the plunger when it has been drawn back."""
        import pygame

        now = time.perf_counter()
        if self._pulled:
            if now - self._pulled > PULL_TIME:
                post_key(pygame.K_SPACE, False)
                self._pulled = 0.0
        elif game.has_ball_to_launch:
            post_key(pygame.K_SPACE, True)
            self._pulled = now
        elif len(game.world.balls) < (1 if game.mode == "arcade" else 2):
            post_key(pygame.K_SPACE, True)
            post_key(pygame.K_SPACE, False)

    def _play_again(self) -> None:
        """Begin the next arcade game."""
        program = self._window.program
        self._down, self._pulled = [False, False], 0.0
        program.play("arcade", program.board.table.name, program.board.seed)


def post_key(key: int, is_down: bool) -> None:
    """Post the event of a key that goes down or up."""
    import pygame

    kind = pygame.KEYDOWN if is_down else pygame.KEYUP
    pygame.event.post(pygame.Event(kind, key=key, mod=0, scancode=0))


class AttractDriver:
    """Lets a player play in attract mode, and measures how long its decisions take.

    Attributes:
        decisions: Wall time of each decision [s].
        processor: Processor time of each decision [s].
    """

    def __init__(self, name: str, window: Any) -> None:
        window.player_warmup.wait()
        window.program.menus.open_attract()
        window.program.start_demo(name, is_attract=True)
        self._window = window
        self._player = window.program.session.player
        window.program.session.player = self
        self.balls: list[int] = []
        self.decisions: list[float] = []
        self.processor: list[float] = []

    def press(self, world: Any) -> tuple[bool, bool]:
        """The buttons that the watched player holds, timed."""
        wall_start, processor_start = time.perf_counter(), time.thread_time()
        held: tuple[bool, bool] = self._player.press(world)
        wall = time.perf_counter() - wall_start
        if wall > MIN_DECISION_TIME:
            self.decisions.append(wall)
            self.processor.append(time.thread_time() - processor_start)
        return held

    def act(self) -> None:
        """Count the balls; no key is pressed."""
        self.balls.append(len(self._window.program.session.game.world.balls))
