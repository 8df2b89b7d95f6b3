"""How does the contest look? Errors against bounces, and errors against speed."""

from __future__ import annotations

from pathlib import Path

from silverball.benchmarks.peers.accuracy import BOUNCES
from silverball.benchmarks.peers.comparison import Result
from silverball.benchmarks.peers.engines import BATCH, EXTRA, SILVERBALL
from silverball.errors import MissingExtra

COLOURS = {BATCH: "#c2185b", SILVERBALL: "#f48fb1", "pymunk": "#1976d2", "Box2D v3": "#388e3c"}
OTHER_COLOUR = "#8d6e63"
MARKS = ("o", "s", "^")  # of an engine's steppings, the coarsest first
SHOWN = 1  # which of `BOUNCES` the second picture shows


def require_matplotlib() -> None:
    """Say in words, before anything is measured, that the plot needs an extra."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise MissingExtra("a plot", EXTRA) from None


def draw(result: Result, path: Path) -> None:
    """Write the picture to a PNG file."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 5.2), layout="constrained")
    by_bounce, by_speed = figure.subplots(1, 2)
    seen: dict[str, int] = {}
    for row in result.rows:
        number = seen.get(row.engine, 0)
        seen[row.engine] = number + 1
        colour, mark = COLOURS.get(row.engine, OTHER_COLOUR), MARKS[number % len(MARKS)]
        label = f"{row.engine}, {row.stepping}"
        if row.engine != BATCH:  # its errors are those of one world
            by_bounce.plot(BOUNCES, row.errors, color=colour, marker=mark, label=label, lw=1.2)
        by_speed.scatter(
            row.frames_per_second, row.errors[SHOWN], color=colour, marker=mark, s=70, label=label
        )
    by_bounce.set(yscale="log", xlabel="bounces", ylabel="error of the position [u]", xticks=BOUNCES)
    by_bounce.set_title("Error against 50 digits (lower is better)")
    by_speed.set(xscale="log", yscale="log", xlabel="frames of 1/60 s per second, one core")
    by_speed.set(ylabel=f"error after {BOUNCES[SHOWN]} bounce [u]")
    by_speed.set_title("Speed and error (right and low is better)")
    for axes in (by_bounce, by_speed):
        axes.grid(visible=True, which="major", alpha=0.3)
        axes.set_ylim(1e-16, 10.0)
    by_speed.legend(fontsize=8, loc="center")
    figure.suptitle(result.machine, fontsize=9)
    figure.savefig(path, format="png", dpi=130)
