"""Speed of the step in each situation that could be slow, of single calls, and of the start, in one run.

Every batch is measured once per round, one after the other, so a busy moment of the machine affects all of
them. Figures are medians of the rounds, ratios are medians of the ratios within a round.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from silverball.benchmarks.speed import (
    FILL,
    FRAME_RATE,
    WARM_UP_ROUNDS,
    Figure,
    benchmark_boards,
    random_actions,
)
from silverball.table import Cylinder, SlantWall, Table, load_table
from silverball.world import World, WorldBatch

WORLDS = 4096
MANY_WORLDS = 65_536
FRAMES = 60
CALLS = 20_000  # timed calls of one world
STARTS = 5  # timed starts of a program

START = """
import time
started = time.perf_counter()
import silverball
imported = time.perf_counter()
world = silverball.World("classic")
made = time.perf_counter()
world.step()
print(imported - started, time.perf_counter() - started, time.perf_counter() - made)
"""


def measure_step_costs(rounds: int, advance: Callable[[str], None] = lambda _: None) -> list[Figure]:
    """Measure everything; `advance` is called with the name of what is measured next."""
    cases = _cases()
    times: dict[str, list[float]] = {name: [] for name in cases}
    for number in range(rounds + WARM_UP_ROUNDS):
        for name, case in cases.items():
            advance(name)
            seconds = case()
            if number >= WARM_UP_ROUNDS:
                times[name].append(seconds)
    figures = [
        Figure(name, 1e-6 / statistics.median(took), "million frames/s") for name, took in times.items()
    ]
    for name, base, over in (
        ("all cores are faster by", "all cores", "two balls"),
        ("play of rolling balls costs", "two balls", "rolling balls"),
    ):
        shares = [b / a for a, b in zip(times[base], times[over], strict=True)]
        figures.append(Figure(name, statistics.median(shares), "×"))
    advance("rolling from the same places")
    figures.append(_rolling_cost(rounds))
    advance("one world")
    figures += _calls()
    advance("starting")
    return figures + _starts()


def _cases() -> dict[str, Callable[[], float]]:
    """The measured cases, by name: functions that play one round and return the seconds per frame."""
    boards = benchmark_boards(load_table("random"))
    rolling = [_changed(board, friction=0.2, rolling=True) for board in boards]
    return {
        "two balls": _play(boards, threads=1),
        "all cores": _play(boards, threads=None),
        "one frame a call, 65,536 worlds": _play(boards, count=MANY_WORLDS, frames=1),
        "240 ticks a second": _play(boards, tick_rate=240),
        "balls at rest on raised paddles": _rest(),
        "200 parts": _play([crowded_table()], count=WORLDS // 4),
        "rolling balls": _play(rolling),
    }


def _play(
    boards: list[Table], count: int = WORLDS, frames: int = FRAMES, tick_rate: int = FRAME_RATE,
    threads: int | None = 1,
) -> Callable[[], float]:  # fmt: skip
    """Random play with two balls in every world at the start of each call."""
    batch = WorldBatch([boards[i % len(boards)] for i in range(count)], count, 0, tick_rate, threads)
    random = np.random.default_rng(0)
    ticks = tick_rate // FRAME_RATE
    for _ in range(FILL):
        batch.create_balls()
    if frames < FRAMES:  # spread the balls over the board first
        batch.step_unchecked(random_actions(random, FRAMES, count), FRAMES)

    def one_round() -> float:
        for _ in range(FILL):
            batch.create_balls()
        actions = np.repeat(random_actions(random, frames, count), ticks, axis=0)
        started = time.perf_counter()
        batch.step_unchecked(actions, frames * ticks)
        return (time.perf_counter() - started) / (count * frames)

    return one_round


def _rolling_cost(rounds: int) -> Figure:
    """Cost of rolling in the same situations: the same positions, velocities and buttons, for a second.

    In random play, rolling balls are slower and stay longer near the paddles, where a step costs more.
    """
    boards = benchmark_boards(load_table("random"))
    sliding, rolling = (
        WorldBatch([tables[i % len(tables)] for i in range(WORLDS)], WORLDS, 0, FRAME_RATE, 1)
        for tables in (boards, [_changed(board, friction=0.2, rolling=True) for board in boards])
    )
    radius = boards[0].board.ball_radius
    random = np.random.default_rng(0)
    shares = []
    for _ in range(rounds + WARM_UP_ROUNDS):
        for _ in range(FILL):
            sliding.create_balls()
        sliding.step_unchecked(random_actions(random, FRAMES, WORLDS), FRAMES)
        rolling.state[:] = sliding.state
        ball = rolling.state["ball"]
        ball["spin_x"], ball["spin_z"] = ball["vz"] / radius, -ball["vx"] / radius
        actions = random_actions(random, FRAMES, WORLDS)
        times = []
        for batch in (sliding, rolling):
            started = time.perf_counter()
            batch.step_unchecked(actions, FRAMES)
            times.append(time.perf_counter() - started)
        shares.append(times[1] / times[0])
    return Figure("rolling costs from the same places", statistics.median(shares[WARM_UP_ROUNDS:]), "×")


def _rest() -> Callable[[], float]:
    """Both balls at rest on the raised paddles."""
    count = WORLDS // 4
    batch = WorldBatch("classic", count, 0, FRAME_RATE, 1)
    raised = np.zeros((1, count, 3), np.bool_)
    raised[..., :2] = True
    batch.step_unchecked(raised, FRAMES)
    world = World("classic", tick_rate=FRAME_RATE)
    world.step(left=True, right=True, ticks=FRAMES)
    for z in (-2.9, 2.9):
        world.create_ball(position=(-4.5, z))
    world.step(left=True, right=True, ticks=10 * FRAMES)
    assert len(world.balls) == FILL, "the balls do not lie on the paddles"
    batch.state[:] = world.records[0]

    def one_round() -> float:
        started = time.perf_counter()
        batch.step_unchecked(raised, FRAMES)
        return (time.perf_counter() - started) / (count * FRAMES)

    return one_round


def crowded_table() -> Table:
    """A table of 40 × 20 u with 195 cylinders: 202 parts with the paddles, the guides and the borders."""
    classic = load_table("classic")
    pivot_x = -20.0 + 2.8  # [u]
    rows = enumerate(np.arange(-9.5, 18.0, 1.5))
    centers = [(float(x), float(z + 0.8 * (row % 2))) for row, x in rows for z in np.arange(-8.6, 7.9, 1.6)]
    guides = tuple(
        SlantWall(start=(-11.2, side * 10.0), end=(pivot_x + 0.33, side * 2.74)) for side in (-1.0, 1.0)
    )
    return classic.model_copy(
        update={
            "name": "Crowded",
            "board": classic.board.model_copy(update={"length": 40.0, "width": 20.0, "gutter": -19.0}),
            "paddle": tuple(p.model_copy(update={"pivot": (pivot_x, p.pivot[1])}) for p in classic.paddle),
            "slant_wall": guides,
            "triangular_prism": (),
            "cylinder": tuple(Cylinder(center=center, radius=0.3) for center in centers[:195]),
        }
    )


def _changed(table: Table, **board: Any) -> Table:
    return table.model_copy(update={"board": table.board.model_copy(update=board)})


def _calls() -> list[Figure]:
    """Wall time of a call that advances one world by one tick."""
    world = World("classic", seed=1)
    took = np.empty(CALLS)
    for number in range(CALLS):
        if number % 600 == 0:
            while len(world.balls) < FILL:
                world.create_ball()
        started = time.perf_counter()
        world.step(left=number % 200 < 100)
        took[number] = time.perf_counter() - started
    return [
        Figure("one World.step, median", float(np.percentile(took, 50)) * 1e6, "µs"),
        Figure("one World.step, 99 of 100", float(np.percentile(took, 99)) * 1e6, "µs"),
    ]


def _starts() -> list[Figure]:
    """Time from the start of a program to its first step, with and without compiled code on disk."""
    cold: list[list[float]] = []
    warm: list[list[float]] = []
    for _ in range(STARTS):
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "SILVERBALL_CACHE": folder}
            for times in (cold, warm):
                done = subprocess.run(
                    [sys.executable, "-c", START], env=environment, capture_output=True, text=True, check=True
                )
                times.append([float(word) for word in done.stdout.split()])
    return [
        Figure("import silverball", statistics.median(row[0] for row in warm), "s"),
        Figure("to the first step, nothing compiled", statistics.median(row[1] for row in cold), "s"),
        Figure("of which the step's compilation", statistics.median(row[2] for row in cold), "s"),
        Figure("to the first step, compiled before", statistics.median(row[1] for row in warm), "s"),
    ]
