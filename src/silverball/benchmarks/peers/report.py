"""How is the contest told: a table in the terminal, the same in Markdown, and one JSON object."""

from __future__ import annotations

import json
from typing import Any

from silverball.benchmarks.peers.accuracy import BOUNCES
from silverball.benchmarks.peers.comparison import Result, Row, described, orders_ahead
from silverball.benchmarks.peers.engines import BATCH, SILVERBALL

HEADERS = (
    "engine", "step [s]", "frames/s", "a batch is faster by", "one world is faster by", "escapes",
    "deepest [u]", *(f"error after {count} [u]" for count in BOUNCES), "energy error",
)  # fmt: skip


def cells(row: Row, radius: float) -> list[str]:
    """A row as people read it."""
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
    """Frames per second with three digits: 258 k or 8.21 M."""
    return f"{frames / 1e6:.3g} M" if frames >= 1e6 else f"{frames / 1e3:.3g} k"


def ratio(value: float) -> str:
    """A ratio with three digits at most."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def conclusions(result: Result) -> list[str]:
    """What it comes to, in a few lines."""
    lines = []
    for name in dict.fromkeys(row.engine for row in result.rows if row.engine not in (BATCH, SILVERBALL)):
        own = [row for row in result.rows if row.engine == name]
        batch = ", ".join(f"{ratio(row.batch_ratio)} × at {row.stepping}" for row in own)
        world = ", ".join(f"{ratio(row.world_ratio)} ×" for row in own)
        lines.append(
            f"Against {name}, a batch is faster by {batch}; one world stepped from Python by {world}."
        )
    orders = ", ".join(
        f"{order:.1f} after {count}" for order, count in zip(orders_ahead(result), BOUNCES, strict=True)
    )
    lines.append(f"Accuracy, powers of ten ahead of the best peer at any step: {orders} bounces.")
    return lines


def footing(result: Result) -> list[str]:
    """What it was measured on."""
    versions = ", ".join(f"{name} {version}" for name, version in result.versions.items())
    return [
        described(result.plan),
        f"Balls on a board: 2 (in the batch {result.balls:.2f} on average).",
        f"{result.machine}; {versions}",
    ]


def terminal_table(result: Result) -> Any:
    """A table for rich."""
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
    """The table and what belongs to it, in Markdown."""
    lines = ["| " + " | ".join(HEADERS) + " |", "| --- | --- " + "| ---: " * (len(HEADERS) - 2) + "|"]
    lines += ["| " + " | ".join(cells(row, result.ball_radius)) + " |" for row in result.rows]
    lines += ["", *(f"* {line}" for line in conclusions(result)), "", *footing(result)]
    return "\n".join(lines) + "\n"


def as_json(result: Result) -> str:
    """One JSON object."""
    return json.dumps(
        {
            "rows": [row._asdict() for row in result.rows],
            "bounces": BOUNCES,
            "orders_ahead": orders_ahead(result),
            "plan": result.plan._asdict(),
            "balls_in_the_batch": result.balls,
            "machine": result.machine,
            "versions": result.versions,
        },
        indent=2,
    )
