"""Draw the picture of docs/rolling.md: `python docs/make_rolling.py`.

Five balls leave the same place with the same velocity on a large board, seen as the player sees it. It needs
matplotlib: `.venv/bin/pip install '.[bench]'`.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import silverball as sb
from silverball.physics.records import Motion
from silverball.table import Board, Table

PICTURE = Path(__file__).with_name("rolling.png")
VELOCITY = (9.0, 5.0)  # up the table, to the right [u/s]
SECONDS, TICK_RATE = 1.8, 240
SIZE, DOTS_PER_INCH = (6.4, 6.0), 100  # [inch]


class Shot(NamedTuple):
    """One ball: its label, the friction (0: it slides), its spin at the start [rad/s]."""

    name: str
    friction: float
    spin_x: float
    spin_z: float
    colour: str


SHOTS = (
    Shot("slides (no friction)", 0.0, 0.0, 0.0, "0.6"),
    Shot("starts without spin, friction 0.2", 0.2, 0.0, 0.0, "tab:blue"),
    Shot("the same, friction 0.05", 0.05, 0.0, 0.0, "tab:cyan"),
    Shot("topspin, twice that of rolling", 0.2, 40.0, -72.0, "tab:red"),
    Shot("backspin, as much as rolling has topspin", 0.2, -20.0, 36.0, "tab:green"),
)


def path_of(shot: Shot) -> list[tuple[float, float, bool]]:
    """x, z [u] and whether the ball slips, after every tick."""
    board = Board(length=50, width=50, gutter=-24, friction=shot.friction, rolling=shot.friction > 0.0)
    batch = sb.WorldBatch(Table(board=board), tick_rate=TICK_RATE)
    batch.create_balls()
    ball = batch.state["ball"][0][:1]
    ball["x"], ball["z"], (ball["vx"], ball["vz"]) = 0.0, 0.0, VELOCITY
    ball["spin_x"], ball["spin_z"] = shot.spin_x, shot.spin_z
    path = [(0.0, 0.0, True)]
    for _ in range(round(SECONDS * TICK_RATE)):
        batch.step([[False, False, False]])
        path.append((float(ball["x"][0]), float(ball["z"][0]), int(ball["motion"][0]) == Motion.SLIPPING))
    return path


def draw() -> None:
    """Write the picture."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=SIZE, dpi=DOTS_PER_INCH, layout="constrained")
    for shot in SHOTS:
        path = path_of(shot)
        axes.plot([z for _, z, _ in path], [x for x, _, _ in path], color=shot.colour, label=shot.name)
        slips = [(x, z) for x, z, slips in path if slips] if shot.friction else []
        axes.plot([z for _, z in slips], [x for x, _ in slips], color=shot.colour, linewidth=5, alpha=0.4)
    axes.set(xlabel="z, to the player's right [u]", ylabel="x, up the table [u]", aspect="equal")
    axes.grid(alpha=0.3)
    figure.legend(title="thick: it slips", fontsize="small", loc="outside lower center", ncols=2)
    figure.savefig(PICTURE, metadata={"Software": None})


if __name__ == "__main__":
    draw()
    print(f"wrote {PICTURE}")
