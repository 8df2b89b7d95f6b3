"""What does a decision of the planner cost? `python benchmarks/planner.py --table random --seconds 45`.

Plays a game at 240 ticks a second and prints the times of its decisions: those that the processor spent on
them, and those that passed, which are longer where other programs want the processor too.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from silverball.players.planner import BRANCHES, Planner, ticks_per_decision
from silverball.world import World


def main() -> None:
    """Play, and print a line for each measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--table", default="classic")
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=45.0)
    parser.add_argument("--branches", type=int, default=BRANCHES)
    options = parser.parse_args()
    world, planner = World(options.table, options.seed), Planner(options.branches)
    world.create_ball()
    planner.press(world)  # compiles
    spent, passed, steps = [], [], []
    while world.time < options.seconds:
        if not world.balls:
            world.create_ball()
        cpu, wall = time.thread_time(), time.perf_counter()
        buttons = planner.press(world)
        if world.tick % ticks_per_decision(world.tick_rate) == 0:
            spent.append(1e3 * (time.thread_time() - cpu))
            passed.append(1e3 * (time.perf_counter() - wall))
            steps.append(int(planner.state.memories["moves"][0]))
        world.step(*buttons)
    print(
        f"{options.table}: {len(spent)} decisions, {world.drained} balls lost, {world.score:,} points\n"
        f"{'':10}{'mean':>10}{'median':>10}{'p99':>10}{'max':>10}"
    )
    for name, values in (("spent ms", spent), ("passed ms", passed), ("steps", steps)):
        row = np.mean(values), np.median(values), np.quantile(values, 0.99), np.max(values)
        print(f"{name:10}" + "".join(f"{value:10,.2f}" for value in row))


if __name__ == "__main__":
    main()
