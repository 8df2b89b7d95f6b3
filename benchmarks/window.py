"""How smooth is the window, and how long is it until one can play?

    python benchmarks/window.py [--seconds 60] [--player planner]

Opens the real window (under Xvfb: `xvfb-run -a python benchmarks/window.py`), plays with key events and two
balls, and prints the frames a second, the percentiles of the time between frames and of the work in a frame,
the latency from a button to the simulation and to the picture, and the time from the start of Python to the
first picture, to the first game and to the table in full quality. For a cold start set SILVERBALL_CACHE to an
empty folder. Scores go to a folder that is removed again.

With --player nobody presses a key: the program plays by itself, as in attract mode, and what is printed
instead of the latency is how long the player thinks for a tick.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from random import random
from typing import Any

STARTED = time.time()


def seconds_since_python_started() -> float:
    """Wall time since this process began [s]; where the system does not tell, since this file was read."""
    try:
        ticks = int(Path("/proc/self/stat").read_text().rsplit(")", 1)[1].split()[19])
        uptime = float(Path("/proc/uptime").read_text().split()[0])
        return uptime - ticks / os.sysconf("SC_CLK_TCK")
    except OSError:
        return time.time() - STARTED


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--player", help="whom to watch: planner or reflex")
    arguments = parser.parse_args()
    seconds, watched = arguments.seconds, arguments.player

    import numpy as np
    import pygame

    from silverball.app.window import Window
    from silverball.game.view import Mode
    from silverball.players import make_player

    with tempfile.TemporaryDirectory() as folder:
        mode = None if watched else Mode.FREE
        window = Window("random", seed=7, mode=mode, folder=Path(folder))
        window.frame(0.0)
        first_picture = seconds_since_python_started()
        while not window.is_ready:
            window.frame(1 / 20)
            time.sleep(1 / 20)
        window.frame(1 / 60)
        playable = seconds_since_python_started()
        hands: Hands | Watcher
        hands = Watcher(watched, window) if watched else Hands(make_player("reflex"), window, pygame)
        starts, work = [], []
        sharp = 0.0
        end = time.perf_counter() + seconds
        before = time.perf_counter()
        while before < end:
            now = time.perf_counter()
            due = now + 1 / 60
            before = window.picture(before)
            starts.append(now)
            work.append(time.perf_counter() - now)
            if not sharp and window.is_sharp:
                sharp = seconds_since_python_started()
            # A press comes at any moment of the wait for the next picture.
            before = window.poll_until(time.perf_counter() + random() * (due - time.perf_counter()), before)
            hands.move()
            before = window.poll_until(due, before)
        size = window.size
        driver = pygame.display.get_driver()
        latency = window.latency
        window.close()

    def row(values: Iterable[float]) -> str:
        return ", ".join(
            f"p{p:g} {np.percentile(list(values), p) * 1e3:.2f} ms" for p in (50, 90, 99, 99.9, 100)
        )

    print(
        f"first picture {first_picture:.2f} s, playable {playable:.2f} s after the start of Python, ", end=""
    )
    print(f"full quality {sharp:.2f} s" if sharp else "not yet in full quality")
    print(
        f"{len(work) / seconds:.1f} frames/s over {seconds:g} s at {size[0]} × {size[1]} on {driver}, ",
        end="",
    )
    print(f"{np.mean(hands.balls):.2f} balls on average")
    print(f"work in a frame:   {row(work)}")
    print(f"between frames:    {row(np.diff(starts))}")
    if isinstance(hands, Watcher):
        print(f"a decision:        {row(hands.decisions)}  (of {len(hands.decisions)} longer than 0.1 ms)")
        print(f"of the processor:  {row(hands.processor)}")
        return
    print(f"button to tick:    {row(latency.to_tick)}  (of the last {len(latency.to_tick)} presses)")
    print(f"button to picture: {row(latency.to_picture)}")


class Hands:
    """Presses keys as the reflex player says, and keeps two balls on the board."""

    def __init__(self, player: Any, window: Any, pygame: Any) -> None:
        self._player, self._window, self._pygame = player, window, pygame
        self._down = [False, False]
        self.balls: list[int] = []
        player.press(window.program.session.game.world)  # loads its kernel now, not in the middle of a frame

    def move(self) -> None:
        """Press and release what has changed."""
        pygame, world = self._pygame, self._window.program.session.game.world
        self.balls.append(len(world.balls))
        if len(world.balls) < 2:
            pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_SPACE, mod=0, scancode=0))
        for side, held in enumerate(self._player.press(world)):
            if held != self._down[side]:
                self._down[side] = held
                kind = pygame.KEYDOWN if held else pygame.KEYUP
                key = (pygame.K_a, pygame.K_d)[side]
                pygame.event.post(pygame.Event(kind, key=key, mod=0, scancode=0))


class Watcher:
    """Lets the program play in attract mode, and measures how long its player thinks."""

    def __init__(self, name: str, window: Any) -> None:
        window.player_warmup.wait()
        window.program.menus.open_attract()
        window.program.start_demo(name, is_attract=True)
        self._window = window
        self._player = window.program.session.player
        window.program.session.player = self
        self.balls: list[int] = []
        self.decisions: list[float] = []  # [s]
        self.processor: list[float] = []  # [s] of them for which this thread had the processor

    def press(self, world: Any) -> tuple[bool, bool]:
        """What the player presses; between two decisions it does not think."""
        start, begun = time.perf_counter(), time.thread_time()
        held: tuple[bool, bool] = self._player.press(world)
        spent = time.perf_counter() - start
        if spent > 1e-4:
            self.decisions.append(spent)
            self.processor.append(time.thread_time() - begun)
        return held

    def move(self) -> None:
        """Press nothing."""
        self.balls.append(len(self._window.program.session.game.world.balls))


if __name__ == "__main__":
    main()
