"""Report of the comparison: a table for the terminal, Markdown, JSON, or a plot."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from silverball.benchmarks.peers.accuracy import BOUNCES
from silverball.benchmarks.peers.comparison import Result, Row, description, digits_ahead
from silverball.benchmarks.peers.engines import BATCH, EXTRA, SILVERBALL
from silverball.errors import MissingExtra

HEADERS = (
    "engine", "step [s]", "frames/s", "a batch is faster by", "one world is faster by", "escapes",
    "deepest [u]", *(f"error after {count} [u]" for count in BOUNCES), "energy error",
)  # fmt: skip
COLOURS = {BATCH: "#c2185b", SILVERBALL: "#f48fb1", "pymunk": "#1976d2", "Box2D v3": "#388e3c"}
OTHER_COLOUR = "#8d6e63"
MARKERS = ("o", "s", "^")  # for the steppings of an engine, coarsest first
PLOTTED = 1  # index in `BOUNCES` of the errors in the second plot


def cells(row: Row, radius: float) -> list[str]:
    """The cells of a row, formatted."""
    deepest = (
        "0" if row.deepest == 0.0 else f"{row.deepest:.1g}" if row.deepest < 1e-3 else f"{row.deepest:.3f}"
    )
    return [
        row.engine,
        row.stepping,
        speed(row.frames_per_second),
        "–" if row.engine == BATCH else f"{ratio(row.batch_ratio)} ×",
        "–" if row.engine in (BATCH, SILVERBALL) else f"{ratio(row.world_ratio)} ×",
        f"{row.escapes} in {row.watched:,}",
        f"≥ {radius:g}" if row.deepest >= radius else deepest,
        *(f"{error:.1e}" for error in row.errors),
        f"{row.energy:.1e}",
    ]


def speed(frames: float) -> str:
    """Frames per second with three digits, like 258 k or 8.21 M."""
    return f"{frames / 1e6:.3g} M" if frames >= 1e6 else f"{frames / 1e3:.3g} k"


def ratio(value: float) -> str:
    """A ratio with three digits at most."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def conclusions(result: Result) -> list[str]:
    """The result in a few sentences."""
    lines = []
    for name in dict.fromkeys(row.engine for row in result.rows if row.engine not in (BATCH, SILVERBALL)):
        own = [row for row in result.rows if row.engine == name]
        batch = ", ".join(f"{ratio(row.batch_ratio)} × at {row.stepping}" for row in own)
        world = ", ".join(f"{ratio(row.world_ratio)} ×" for row in own)
        lines.append(
            f"Against {name}, a batch is faster by {batch}; one world stepped from Python by {world}."
        )
    orders = ", ".join(
        f"{order:.1f} after {count}" for order, count in zip(digits_ahead(result), BOUNCES, strict=True)
    )
    lines.append(f"Accuracy, powers of ten ahead of the best peer at any step: {orders} bounces.")
    return lines


def footer(result: Result) -> list[str]:
    """What was measured, and on which machine and versions."""
    versions = ", ".join(f"{name} {version}" for name, version in result.versions.items())
    return [
        description(result.plan),
        f"Balls on a board: 2 (in the batch {result.balls:.2f} on average).",
        f"{result.machine}; {versions}",
    ]


def terminal_table(result: Result) -> Any:
    """The table for the terminal."""
    from rich.table import Table

    table = Table(title="The same table in every engine")
    for index, header in enumerate(HEADERS):
        table.add_column(header, justify="left" if index < 2 else "right", no_wrap=index < 2)
    name = ""
    for row in result.rows:
        if name and row.engine.split(",")[0] != name:
            table.add_section()
        name = row.engine.split(",")[0]
        table.add_row(*cells(row, result.ball_radius))
    return table


def markdown(result: Result) -> str:
    """The table, the result and its conditions, in Markdown."""
    lines = ["| " + " | ".join(HEADERS) + " |", "| --- | --- " + "| ---: " * (len(HEADERS) - 2) + "|"]
    lines += ["| " + " | ".join(cells(row, result.ball_radius)) + " |" for row in result.rows]
    lines += ["", *(f"* {line}" for line in conclusions(result)), "", *footer(result)]
    return "\n".join(lines) + "\n"


def as_json(result: Result) -> str:
    """All figures as one JSON object."""
    return json.dumps(
        {
            "rows": [row._asdict() for row in result.rows],
            "bounces": BOUNCES,
            "orders_ahead": digits_ahead(result),
            "plan": result.plan._asdict(),
            "balls_in_the_batch": result.balls,
            "machine": result.machine,
            "versions": result.versions,
        },
        indent=2,
    )


def require_matplotlib() -> None:
    """Check, before anything is measured, that a plot can be drawn.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise MissingExtra("a plot", EXTRA) from None


def draw_plot(result: Result, path: Path) -> None:
    """Plot errors against bounces and against speed into a PNG."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 5.2), layout="constrained")
    by_bounce, by_speed = figure.subplots(1, 2)
    rows_of: dict[str, int] = {}
    for row in result.rows:
        number = rows_of.get(row.engine, 0)
        rows_of[row.engine] = number + 1
        colour, marker = COLOURS.get(row.engine, OTHER_COLOUR), MARKERS[number % len(MARKERS)]
        label = f"{row.engine}, {row.stepping}"
        if row.engine != BATCH:  # it has the errors of one world
            by_bounce.plot(BOUNCES, row.errors, color=colour, marker=marker, label=label, lw=1.2)
        by_speed.scatter(
            row.frames_per_second, row.errors[PLOTTED], color=colour, marker=marker, s=70, label=label
        )
    by_bounce.set(yscale="log", xlabel="bounces", ylabel="error of the position [u]", xticks=BOUNCES)
    by_bounce.set_title("Error against 50 digits (lower is better)")
    by_speed.set(xscale="log", yscale="log", xlabel="frames of 1/60 s per second, one core")
    by_speed.set(ylabel=f"error after {BOUNCES[PLOTTED]} bounce [u]")
    by_speed.set_title("Speed and error (right and low is better)")
    for axes in (by_bounce, by_speed):
        axes.grid(visible=True, which="major", alpha=0.3)
        axes.set_ylim(1e-16, 10.0)
    by_speed.legend(fontsize=8, loc="center")
    figure.suptitle(result.machine, fontsize=9)
    figure.savefig(path, format="png", dpi=130)
