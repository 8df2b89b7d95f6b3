"""Draw the pictures of docs/feel.md and print its figures: `python docs/make_feel.py`.

For each built-in table, or those named: where balls spend their time, and the direction of a shot for each
moment of the press. It needs matplotlib: `.venv/bin/pip install '.[bench]'`.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from silverball.cli.feel import build_report, print_report
from silverball.metrics.feel import Feel, measure
from silverball.metrics.game_traces import CELLS, TICK_RATE
from silverball.metrics.shots import Aim, Shots
from silverball.table import Table, load_table

FOLDER = Path(__file__).parent
GAMES, SEED = 1000, 0
SIZE, DOTS_PER_INCH = (10.0, 5.6), 80  # [inch]
PLAYERS = ("idle", "reflex")
COLOURS = {Aim.NOWHERE: "0.75", Aim.LEFT: "tab:blue", Aim.MIDDLE: "tab:orange", Aim.RIGHT: "tab:green"}


def draw_parts(axes: Any, table: Table) -> None:
    """The outlines of the parts, as the player sees them."""
    from matplotlib.patches import Circle, Polygon

    line = {"fill": False, "edgecolor": "white", "linewidth": 1.0}
    for wall in table.slant_wall:
        (x0, z0), (x1, z1) = wall.start, wall.end
        axes.plot([z0, z1], [x0, x1], color="white", linewidth=1.5)
    for prism in table.triangular_prism:
        axes.add_patch(Polygon([(z, x) for x, z in prism.corners()], **line))
    for paddle in table.paddle:
        axes.add_patch(Polygon([(z, x) for x, z in paddle.corners(paddle.rest_angle)], **line))
    for cylinder in table.cylinder:
        x, z, radius = cylinder.circle()
        axes.add_patch(Circle((z, x), radius, **line))


def draw_heat(axes: Any, feel: Feel, player: str) -> None:
    """Where the balls of a player spend their time, brighter by powers of ten."""
    from matplotlib.colors import LogNorm

    heat = feel.players[player].games.heat[:-1, :-1]
    board = feel.table.board
    seconds = heat / TICK_RATE / GAMES * CELLS**2
    edges = (-0.5 * board.width, 0.5 * board.width, -0.5 * board.length, 0.5 * board.length)
    picture = axes.imshow(
        np.where(seconds > 0.0, seconds, np.nan), origin="lower", extent=edges, cmap="inferno",
        norm=LogNorm(seconds.max() / 1000.0, seconds.max()),
    )  # fmt: skip
    axes.set_facecolor("black")
    axes.figure.colorbar(picture, ax=axes, shrink=0.8, label="s per game and u²")
    draw_parts(axes, feel.table)
    mean = feel.players[player].figures["seconds_per_ball"].value
    axes.set(title=f"{player}: {mean:.1f} s a ball", xlabel="z [u]", ylabel="x [u]")


def draw_shots(axes: Any, shots: Shots) -> None:
    """Where a shot goes, for each moment of the press."""
    struck = np.nonzero(shots.shot["launched"])[0]
    ms = (np.arange(len(shots.aim)) - struck[0]) * 1000.0 / TICK_RATE
    for aim, colour in COLOURS.items():
        rows = struck[shots.aim[struck] == aim]
        name = "nowhere" if aim == Aim.NOWHERE else f"{aim.name.lower()}: {shots.window(aim)[0]:.0f} ms"
        axes.plot(ms[rows], shots.shot["direction"][rows], ".", color=colour, markersize=3, label=name)
    way = "held, then dropped" if shots.held else "down the guide"
    axes.set(title=f"{shots.side} paddle, ball {way}", xlabel="press [ms]", ylabel="direction [deg]")
    axes.set_ylim(-45.0, 70.0)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="x-small", loc="upper left")


def draw(feel: Feel, path: Path) -> None:
    """The picture of a table."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=SIZE, dpi=DOTS_PER_INCH, layout="constrained")
    heats, maps = figure.subfigures(1, 2, width_ratios=(3, 2))
    for axes, player in zip(heats.subplots(1, len(PLAYERS)), PLAYERS, strict=True):
        draw_heat(axes, feel, player)
    left = [shots for shots in feel.shots if shots.side == "left"]
    for axes, shots in zip(maps.subplots(len(left), 1), left, strict=True):
        draw_shots(axes, shots)
    figure.savefig(path, metadata={"Software": None})
    pyplot.close(figure)


if __name__ == "__main__":
    for name in sys.argv[1:] or ("classic", "random", "rolling"):
        measured = measure(load_table(name), GAMES, SEED)
        print_report({"table": name, "seed": SEED, "games": GAMES, **build_report(measured)})
        file = FOLDER / f"feel_{Path(name).stem}.png"
        draw(measured, file)
        print(f"wrote {file}\n")
