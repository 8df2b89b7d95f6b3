"""Random play in an engine, and its speed.

Every engine gets the same random buttons. A drained ball is replaced in the next frame at the next of a list
of free places, which is the same for all engines.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from itertools import cycle

import numpy as np
from numpy.typing import NDArray

from silverball.benchmarks.peers.playfield import Playfield
from silverball.table import Table
from silverball.world import WorldBatch

HOLD = 6  # frames between two changes of a button
BALLS = 2
PLACES = 256
FRAMES_PER_CLOCK = 200  # frames between two readings of the clock


def random_presses(frames: int, seed: int) -> NDArray[np.bool_]:
    """Random buttons, each held or released for `HOLD` frames at a time: bool [frame, 2], left and right."""
    held = np.random.default_rng(seed).random((-(-frames // HOLD), 2)) < 0.5
    return np.repeat(held, HOLD, axis=0)[:frames]


def free_places(table: Table, seed: int, count: int = PLACES) -> list[tuple[float, float]]:
    """Positions (x, z) [u] at which a ball overlaps nothing and is out of reach of the paddles."""
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
        """Add balls, clear of each other, until there are two."""
        while self.field.ball_count < BALLS:
            x, z = next(self.places)
            if all(math.hypot(x - bx, z - bz) > self.apart for bx, bz, _, _ in self.field.balls()):
                self.field.add_ball(x, z)
                self.created += 1

    def run(self, frames: int) -> None:
        """Play a number of frames."""
        field, press = self.field, self.press
        for _ in range(frames):
            left, right = next(press)
            field.frame(left, right)
            if field.ball_count < BALLS:
                self.fill()


def speed(game: Game, seconds: float) -> float:
    """Frames of 1/60 s per second of wall time, measured for about `seconds` [s]."""
    game.run(FRAMES_PER_CLOCK)
    frames, started = 0, time.perf_counter()
    while True:
        game.run(FRAMES_PER_CLOCK)
        frames += FRAMES_PER_CLOCK
        elapsed = time.perf_counter() - started
        if elapsed >= seconds:
            return frames / elapsed
