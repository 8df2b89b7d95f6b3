"""The table in Silverball: one world stepped from Python, and a batch stepped by one call.

A `World` is driven exactly as the peers are, one world and one call per step. The peers have no batch:
thousands of worlds stepped by one call, here on one core.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from silverball.benchmarks.peers.playfield import FRAME_RATE, Playfield, Stepping
from silverball.table import Table
from silverball.world import World, WorldBatch

RECOMMENDED = Stepping(1)
FRAMES_PER_CALL = 60


class SilverballPlayfield(Playfield):
    """A table in a `silverball.World`."""

    def __init__(self, table: Table, stepping: Stepping) -> None:
        super().__init__(table, stepping)
        self.world = World(table, seed=0, tick_rate=FRAME_RATE * stepping.steps)
        self.world_step = self.world.step
        self.entered = 0  # balls added less balls removed

    def step(self, left: bool, right: bool) -> None:
        """Advance by one tick."""
        self.world_step(left, right)

    def finish_frame(self) -> None:
        """Do nothing: the world drains balls and applies the speed cap itself."""

    def add_ball(self, x: float, z: float, vx: float = 0.0, vz: float = 0.0) -> None:
        """Add a ball with its centre at (x, z) [u] and a velocity [u/s]."""
        self.world.create_ball((x, z), (vx, vz))
        self.entered += 1

    def remove_ball(self, index: int) -> None:
        """Remove a ball, by its index in `balls`."""
        record = self.world.records[0]["ball"]
        record[np.flatnonzero(record["id"])[index]] = 0
        self.entered -= 1

    def balls(self) -> list[tuple[float, float, float, float]]:
        """x, z, vx, vz of every ball."""
        record = self.world.records[0]["ball"]
        alive = record[record["id"] != 0]
        found: list[tuple[float, float, float, float]] = alive[["x", "z", "vx", "vz"]].tolist()
        return found

    def angles(self) -> tuple[float, float]:
        """The left and the right paddle's angle [rad]."""
        left, right = self.world.records[0]["paddle"]["angle"][:2].tolist()
        return left, right

    @property
    def ball_count(self) -> int:
        """Number of balls on the board."""
        return self.entered - self.world.drained


def batch_speed(
    table: Table, worlds: int, calls: int, press: NDArray[np.bool_], seed: int
) -> tuple[float, float]:
    """Frames of 1/60 s per second of a batch on one core, and the mean number of balls on a board.

    Args:
        table: A finished table.
        worlds: Number of worlds.
        calls: Timed calls of `FRAMES_PER_CALL` frames; drained balls are replaced before each call, which is
            timed too.
        press: Buttons of the peers' play, bool [frame, 2]; each world starts at a different frame of them.
        seed: Seed of the batch.
    """
    batch = WorldBatch(table, worlds, seed, FRAME_RATE, threads=1)
    starts = np.arange(worlds) * 7919 % len(press)
    seconds, balls = 0.0, []
    for call in range(-1, calls):  # the first call warms up
        rows = (np.arange(FRAMES_PER_CALL)[:, None] + starts + call * FRAMES_PER_CALL) % len(press)
        actions = np.zeros((FRAMES_PER_CALL, worlds, 3), np.bool_)
        actions[..., :2] = press[rows]
        started = time.perf_counter()
        for _ in range(table.board.max_balls):
            batch.create_balls()
        before = float((batch.state["ball"]["id"] != 0).sum())
        batch.step_unchecked(actions, FRAMES_PER_CALL)
        if call >= 0:
            seconds += time.perf_counter() - started
            balls.append((before + float((batch.state["ball"]["id"] != 0).sum())) / (2 * worlds))
    return worlds * calls * FRAMES_PER_CALL / seconds, float(np.mean(balls))
