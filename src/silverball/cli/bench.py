"""`silverball bench`: how fast is the step here?"""

from __future__ import annotations

import json
from typing import Any

import typer

MOST_ACTIONS = 300_000_000  # three bytes each


def bench(
    worlds: int = typer.Option(4096, min=1, max=1_000_000, help="Worlds side by side."),
    frames: int = typer.Option(60, min=1, max=10_000, help="Frames of 1/60 s in one call."),
    rounds: int = typer.Option(9, min=1, max=1000, help="Timed calls; the median counts."),
    threads: int = typer.Option(1, min=1, max=1024, help="Threads; 1 gives the speed of one core."),
    table: str = typer.Option("random", help="A built-in table or a table file."),
    as_json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Measure the speed of the compiled step: frames of 1/60 s, two balls, random paddles.

    Example: `silverball bench --json`
    """
    from silverball.cli.console import compiling, errors
    from silverball.errors import SilverballError

    if worlds * frames > MOST_ACTIONS:
        raise SilverballError(
            f"--worlds {worlds} times --frames {frames} are more actions than memory should hold; "
            f"keep the product below {MOST_ACTIONS:,}"
        )
    with compiling():
        from silverball.players.benchmark import measure
        from silverball.table import load_table

        loaded = load_table(table)
    with errors.status("measuring …"):
        report: dict[str, Any] = measure(loaded, worlds, frames, rounds, threads)._asdict()
    if as_json:
        typer.echo(json.dumps(report, indent=2))
        return
    typer.echo(
        f"{report['frames_per_second'] / 1e6:.2f} million frames/s on {report['threads']} thread(s), "
        f"the median of {report['rounds']} (slowest {report['slowest'] / 1e6:.2f}, "
        f"fastest {report['fastest'] / 1e6:.2f})"
    )
    typer.echo(
        f"a frame is 1/60 s of one world with {report['balls']:.2f} balls and random paddles; "
        f"{worlds} worlds, {frames} frames a call, {report['boards']} board(s)"
    )
    typer.echo(
        f"{report['machine']}; Python {report['python']}, numba {report['numba']}, numpy {report['numpy']}"
    )
