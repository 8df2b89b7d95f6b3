"""Draw the picture of docs/benchmark.md: `python docs/make_benchmark.py`.

The learning curves in `docs/benchmark_results/`, one panel for each of the tables, beside the best rhythm and
the reflex player. It needs matplotlib: `.venv/bin/pip install '.[bench]'`.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

RESULTS = Path(__file__).with_name("benchmark_results")
PICTURE = Path(__file__).with_name("benchmark_curves.png")
GROWTH = 1.15  # of the stretches of steps whose balls are put together

CURVES = {
    "classic": {
        "PPO": ("ppo_classic_*", "#1565c0"),
        "DQN": ("dqn_classic_*", "#ef6c00"),
        "QR-DQN": ("qr_dqn_classic_*", "#6a1b9a"),
        "PPO, positions": ("ppo_positions_*", "#9aa7b8"),
        "PPO, positions, memory": ("ppo_memory_*", "#00838f"),
        "DQN, pictures": ("dqn_pictures_classic_*", "#ad1457"),
    },
    "random boards": {
        "PPO": ("ppo_boards_*", "#1565c0"),
        "DQN, pictures": ("dqn_pictures_boards_*", "#ad1457"),
        "PPO, pictures": ("ppo_pictures_boards_*", "#5d4037"),
    },
}
LINES = {"classic": "results_classic.csv", "random boards": "results_boards.csv"}
PLAYERS = {"blind": "#c62828", "reflex": "#2e7d32"}


def curve_of(path: Path) -> tuple[list[float], list[float]]:
    """Steps [million] and mean points of the balls in each stretch, the later the longer."""
    stretches: dict[int, list[tuple[float, float]]] = {}
    with path.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            stretch = round(math.log(int(row["steps"])) / math.log(GROWTH))
            stretches.setdefault(stretch, []).append((float(row["points_a_ball"]), float(row["balls"])))
    steps = [GROWTH**stretch / 1e6 for stretch in stretches]
    points = [_mean(balls) for balls in stretches.values()]
    return steps, points


def _mean(balls: list[tuple[float, float]]) -> float:
    return sum(points * count for points, count in balls) / sum(count for _, count in balls)


def points_of(path: Path, player: str) -> float:
    """Mean points a ball of a player in a table of results."""
    with path.open(encoding="utf-8") as file:
        return float(
            np.mean([int(row["points"]) for row in csv.DictReader(file) if row["contestant"] == player])
        )


def draw() -> None:
    """Draw both panels."""
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
    for axes, (table, curves) in zip(panels, CURVES.items(), strict=True):
        for name, (pattern, colour) in curves.items():
            for number, path in enumerate(sorted(RESULTS.glob(f"{pattern}.csv"))):
                label = name if number == 0 else None
                axes.plot(*curve_of(path), color=colour, linewidth=1.5, label=label)
        for player, colour in PLAYERS.items():
            height = points_of(RESULTS / LINES[table], player)
            axes.axhline(height, color=colour, linestyle="--", label=f"the player {player}")
        axes.set(title=table, xlabel="steps [million]", xscale="log", ylim=(0, None))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_major_formatter("{x:,.0f}")
        axes.grid(alpha=0.3)
        axes.legend(loc="upper left", fontsize="small", framealpha=1.0)
    panels[0].set_ylabel("points a ball in the training")
    figure.savefig(PICTURE, dpi=120)
    print(f"wrote {PICTURE}")


if __name__ == "__main__":
    draw()
