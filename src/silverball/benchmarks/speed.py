"""Speed of the step on this machine, in frames of 1/60 s per second."""

from __future__ import annotations

import os
import platform
import statistics
import time
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from silverball.table import Table
from silverball.world import WorldBatch

FRAME_RATE = 60
HOLD = 6  # frames between two changes of a random button
BOARDS = 16  # distinct boards of a benchmark on a recipe
FILL = 2  # balls per world
WARM_UP_ROUNDS = 2  # before the timed ones: they compile and warm up the caches


class Figure(NamedTuple):
    """One measured figure: its name, its value, and the unit of the value."""

    name: str
    value: float
    unit: str


class Speed(NamedTuple):
    """A measured speed, and the conditions of the measurement.

    Attributes:
        frames_per_second: Frames of 1/60 s in all worlds per second, median of the rounds.
        slowest: Frames per second in the slowest round.
        fastest: Frames per second in the fastest round.
        balls: Mean number of balls per world at the start of a round.
    """

    frames_per_second: float
    slowest: float
    fastest: float
    balls: float
    rounds: int
    threads: int
    worlds: int
    frames: int
    boards: int
    machine: str
    python: str
    numba: str
    numpy: str


def measure(table: Table, worlds: int, frames: int, rounds: int, threads: int) -> Speed:
    """Time calls of `frames` frames each, with random paddles and two balls per world at each start."""
    boards = benchmark_boards(table)
    batch = WorldBatch([boards[i % len(boards)] for i in range(worlds)], worlds, 0, FRAME_RATE, threads)
    random = np.random.default_rng(0)
    speeds, balls = [], []
    for index in range(rounds + WARM_UP_ROUNDS):
        for _ in range(FILL):
            batch.create_balls()
        actions = random_actions(random, frames, worlds)
        balls.append(float((batch.state["ball"]["id"] != 0).sum() / worlds))
        started = time.perf_counter()
        batch.step_unchecked(actions, frames)
        if index >= WARM_UP_ROUNDS:
            speeds.append(worlds * frames / (time.perf_counter() - started))
    return Speed(
        statistics.median(speeds),
        min(speeds),
        max(speeds),
        statistics.mean(balls),
        rounds,
        threads,
        worlds,
        frames,
        len(boards),
        machine(),
        platform.python_version(),
        numba.__version__,
        np.__version__,
    )


def machine() -> str:
    """Processor architecture, number of cores and system of this machine."""
    return f"{platform.machine()}, {os.cpu_count()} cores, {platform.system()}"


def benchmark_boards(table: Table) -> list[Table]:
    """The boards of a benchmark: the table, or `BOARDS` boards of a recipe."""
    if table.random is None:
        return [table]
    from silverball.table import generate_table

    return [generate_table(seed, table) for seed in range(BOARDS)]


def random_actions(random: np.random.Generator, frames: int, worlds: int) -> NDArray[np.bool_]:
    """Random actions without jitter: bool [frame, world, 3]."""
    held = random.random((-(-frames // HOLD), worlds, 3)) < 0.5
    held[..., 2] = False
    return np.ascontiguousarray(np.repeat(held, HOLD, axis=0)[:frames])
