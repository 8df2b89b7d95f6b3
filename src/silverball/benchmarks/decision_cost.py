"""Cost of a decision of the planner: processor time, wall time and simulated steps.

Wall times are longer than processor times where other programs compete for the processor.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from silverball.benchmarks.speed import Figure
from silverball.players.planner import BRANCHES, Planner, ticks_per_decision
from silverball.table import Table
from silverball.world import World


def measure_planner(
    table: Table,
    seed: int,
    seconds: float,
    branches: int | None = None,
    advance: Callable[[str], None] = lambda _: None,
) -> list[Figure]:
    """Time the decisions of the planner in a game at 240 ticks per second.

    Args:
        table: A table, or a recipe for the board of the game.
        seed: Seed of the game.
        seconds: Simulated length of the game [s].
        branches: Branches per decision; None for the planner's own number.
        advance: Called with the name of what is measured next.
    """
    world, planner = World(table, seed), Planner(BRANCHES if branches is None else branches)
    world.create_ball()
    advance("compiling the planner")
    planner.press(world)
    advance(f"playing {seconds:g} s")
    processor, wall, steps = [], [], []
    while world.time < seconds:
        if not world.balls:
            world.create_ball()
        processor_start, wall_start = time.thread_time(), time.perf_counter()
        buttons = planner.press(world)
        if world.tick % ticks_per_decision(world.tick_rate) == 0:
            processor.append(1e3 * (time.thread_time() - processor_start))
            wall.append(1e3 * (time.perf_counter() - wall_start))
            steps.append(int(planner.state.memories["moves"][0]))
        world.step(*buttons)
    figures = [
        Figure("decisions", len(wall), ""),
        Figure("balls drained", world.drained, ""),
        Figure("score", world.score, "points"),
    ]
    for name, values, unit in (
        ("processor time of a decision", processor, "ms"),
        ("wall time of a decision", wall, "ms"),
        ("steps of a decision", steps, ""),
    ):
        figures += [
            Figure(f"{name}, mean", float(np.mean(values)), unit),
            Figure(f"{name}, median", float(np.median(values)), unit),
            Figure(f"{name}, 99 %", float(np.quantile(values, 0.99)), unit),
            Figure(f"{name}, longest", float(np.max(values)), unit),
        ]
    return figures
