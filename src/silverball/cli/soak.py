"""What does `silverball simulate --soak` do and print?"""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any, NoReturn

import typer

SHOWN_FINDINGS = 10


def run_soak(
    table: str, seed: int, worlds: int, tick_rate: int, hostile: bool, frames: int, progress: Path | None
) -> dict[str, Any]:
    """Soak until so many frames are done; what came of it, for `print_soak`."""
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors
    from silverball.game.folder import data_folder
    from silverball.table import load_table

    recipe = load_table(table)
    with compiling("soak_worlds"):
        from silverball.players.soak import Options, Soaked
        from silverball.players.soaklog import begun, log_name, soak

        options = Options(recipe, seed, worlds, tick_rate, hostile)
        path = progress or data_folder() / "soak" / log_name(options)
        earlier = begun(options, path)
        Soaked([load_table("classic")], [seed], tick_rate, hostile).run(1)
    started = time.perf_counter()
    try:
        with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
            task = bar.add_task(f"soaking {frames:,} frames", total=frames, completed=earlier.totals.frames)
            log = soak(options, frames, path, lambda done: bar.update(task, completed=done))
    except KeyboardInterrupt:
        errors.print(f"what was done is kept in {path}: the same command goes on from there", soft_wrap=True)
        raise
    seconds = time.perf_counter() - started
    return {
        "table": "hostile" if hostile else table,
        "seed": seed,
        "tick_rate": tick_rate,
        "worlds": worlds,
        "rounds": log.rounds,
        "frames": log.totals.frames,
        "boards": log.totals.boards,
        "balls_created": log.totals.created,
        "balls_drained": log.totals.drained,
        "hits": log.totals.hits,
        "jams": log.totals.jams,
        "deepest_penetration": log.totals.deepest,
        "findings": log.totals.found,
        "files": [str(path.with_name(name)) for name in log.findings],
        "progress": str(path),
        "frames_per_second": (log.totals.frames - earlier.totals.frames) / seconds,
    }


def print_soak(report: dict[str, Any], as_json: bool) -> NoReturn:
    """Print what came of a soak; it ends with exit code 1 if anything was found."""
    count = sum(report["findings"].values())
    if as_json:
        typer.echo(json.dumps(report, indent=2))
        raise typer.Exit(1 if count else 0)
    typer.echo(
        f"{report['frames']:,} frames of 1/{report['tick_rate']} s on {report['boards']:,} boards "
        f"({report['table']}, seed {report['seed']}), {report['frames_per_second'] / 1e6:.2f} million/s"
    )
    typer.echo(
        f"{report['balls_created']:,} balls, {report['hits']:,} hits, {report['jams']:,} jams; "
        f"deepest penetration {report['deepest_penetration']:.3g} u"
    )
    typer.echo(", ".join(f"{kind} {number:,}" for kind, number in report["findings"].items()))
    for name in report["files"][:SHOWN_FINDINGS]:
        typer.echo(f"  silverball simulate --soak --again {name}")
    typer.echo(f"kept in {report['progress']}")
    raise typer.Exit(1 if count else 0)


def soak_again(path: Path, as_json: bool) -> NoReturn:
    """Do a finding again and say whether it happens; exit code 1 if it does."""
    from silverball.cli.console import compiling

    with compiling("watched_tick"):
        from silverball.players.finding import Finding, again
        from silverball.players.watch import Found

        finding = Finding.from_text(path.read_text(encoding="utf-8", errors="replace"), str(path))
        found = again(finding)
    happens = found.name.lower() == finding.kind
    if as_json:
        report = {"kind": finding.kind, "found": found.name.lower(), "happens_again": happens}
        typer.echo(json.dumps(report, indent=2))
    elif happens:
        typer.echo(f"{path}: the {finding.kind} of ball {finding.ball} happens again")
    elif found != Found.NOTHING:
        typer.echo(f"{path}: instead of the {finding.kind} there is now: {found.name.lower()}")
    else:
        typer.echo(f"{path}: the {finding.kind} does not happen any more")
    raise typer.Exit(0 if found == Found.NOTHING else 1)
