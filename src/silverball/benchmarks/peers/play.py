"""How does an engine play at random, and how fast?

The paddles are pressed by the same random numbers in every engine; a ball that has drained is replaced in the
next frame at one of a list of free places, the same list for all.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from itertools import cycle

import numpy as np
from numpy.typing import NDArray

from silverball.benchmarks.peers.engine import Playfield
from silverball.table import Table
from silverball.world import WorldBatch

HOLD = 6  # frames for which a button stays as it is
BALLS = 2
PLACES = 256
CLOCK_FRAMES = 200  # frames between two looks at the clock


def random_presses(frames: int, seed: int) -> NDArray[np.bool_]:
    """Buttons (left, right), held or not for some frames at a time: bool [frame, 2]."""
    held = np.random.default_rng(seed).random((-(-frames // HOLD), 2)) < 0.5
    return np.repeat(held, HOLD, axis=0)[:frames]


def free_places(table: Table, seed: int, count: int = PLACES) -> list[tuple[float, float]]:
    """Places (x, z) [u] where a ball overlaps nothing and the paddles do not reach."""
    batch = WorldBatch(table, count, seed, threads=1)
    batch.create_balls()
    places: list[tuple[float, float]] = batch.state["ball"][:, 0][["x", "z"]].tolist()
    return places


class Game:
    """A playfield with two balls and random paddles, one frame at a time."""

    def __init__(self, field: Playfield, press: NDArray[np.bool_], places: list[tuple[float, float]]) -> None:
        self.field = field
        self.press: Iterator[list[bool]] = cycle(press.tolist())
        self.places = cycle(places)
        self.apart = 2.0 * field.table.board.ball_radius + 0.05
        self.created = 0
        self.fill()

    def fill(self) -> None:
        """New balls until there are two, clear of each other."""
        while self.field.ball_count < BALLS:
            x, z = next(self.places)
            if all(math.hypot(x - bx, z - bz) > self.apart for bx, bz, _, _ in self.field.balls()):
                self.field.put_ball(x, z)
                self.created += 1

    def run(self, frames: int) -> None:
        """Play on for some frames."""
        field, press = self.field, self.press
        for _ in range(frames):
            left, right = next(press)
            field.frame(left, right)
            if field.ball_count < BALLS:
                self.fill()


def speed(game: Game, seconds: float) -> float:
    """Frames of 1/60 s per second of wall time, played for about so many seconds."""
    game.run(CLOCK_FRAMES)
    frames, started = 0, time.perf_counter()
    while True:
        game.run(CLOCK_FRAMES)
        frames += CLOCK_FRAMES
        taken = time.perf_counter() - started
        if taken >= seconds:
            return frames / taken
