"""How smooth is the window, and how long is it until one can play?

    python benchmarks/window.py [--seconds 60]

Opens the real window (under Xvfb: `xvfb-run -a python benchmarks/window.py`), plays with real key events
and two balls, and prints the frames a second, the percentiles of the time between frames and of the work in
a frame, and the time from the start of Python to the first picture and to the first game. For a cold start
set SILVERBALL_CACHE to an empty folder.
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

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
    seconds = parser.parse_args().seconds

    import numpy as np
    import pygame

    from silverball.app.window import Window

    window = Window("random", seed=7)
    window.frame(0.0)
    first_picture = seconds_since_python_started()
    while not window.is_ready:
        window.frame(1 / 60)
        time.sleep(0.005)
    window.frame(1 / 60)
    playable = seconds_since_python_started()

    from silverball.players import make_player

    player = make_player("reflex")
    assert window.session is not None
    player.press(window.session.world)  # loads its kernel now, not in the middle of a frame
    keys = {0: pygame.K_a, 1: pygame.K_d}
    down = [False, False]
    work, between, balls = [], [], []
    pacer = pygame.time.Clock()
    end = time.perf_counter() + seconds
    before = time.perf_counter()
    while before < end:
        world = window.session.world
        if len(world.balls) < 2:
            pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_SPACE, mod=0, scancode=0))
        for side, held in enumerate(player.press(world)):
            if held != down[side]:
                down[side] = held
                kind = pygame.KEYDOWN if held else pygame.KEYUP
                pygame.event.post(pygame.Event(kind, key=keys[side], mod=0, scancode=0))
        now = time.perf_counter()
        window.frame(now - before)
        work.append(time.perf_counter() - now)
        between.append(now - before)
        balls.append(len(window.session.world.balls))
        before = now
        pacer.tick(60)
    size = window._screen.surface.get_size()
    driver = pygame.display.get_driver()
    window.close()

    def row(values: list[float]) -> str:
        return ", ".join(f"p{p:g} {np.percentile(values, p) * 1e3:.2f} ms" for p in (50, 90, 99, 99.9, 100))

    print(f"first picture {first_picture:.2f} s, playable {playable:.2f} s after the start of Python")
    print(
        f"{len(work) / seconds:.1f} frames/s over {seconds:g} s at {size[0]} × {size[1]} on {driver}, ",
        end="",
    )
    print(f"{np.mean(balls):.2f} balls on average")
    print(f"work in a frame: {row(work)}")
    print(f"between frames:  {row(between[1:])}")


if __name__ == "__main__":
    main()
