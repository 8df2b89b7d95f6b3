"""What does `silverball simulate --soak` do and print?"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, NoReturn

import typer

from silverball.cli.say import say, say_json
from silverball.errors import StateError

SHOWN_FINDINGS = 10


def run_soak(
    table: str, seed: int, worlds: int, tick_rate: int, hostile: bool, frames: int, progress: Path | None
) -> dict[str, Any]:
    """Soak until so many frames are done; what came of it, for `print_soak`."""
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors
    from silverball.game.user_folder import data_folder
    from silverball.table import load_table

    recipe = load_table(table)
    with compiling("soak_worlds"):
        from silverball.soak.campaign import load_or_begin, log_name, soak
        from silverball.soak.rounds import Options, SoakBatch

        options = Options(recipe, seed, worlds, tick_rate, hostile)
        path = progress or data_folder() / "soak" / log_name(options)
        earlier = load_or_begin(options, path)
        SoakBatch([load_table("classic")], [seed], tick_rate, hostile).run(1)
    started = time.perf_counter()
    try:
        with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
            task = bar.add_task(f"soaking {frames:,} frames", total=frames, completed=earlier.totals.frames)
            log = soak(options, frames, path, lambda done: bar.update(task, completed=done))
    except KeyboardInterrupt:
        say(f"what was done is kept in {path}: the same command goes on from there", err=True)
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
        say_json(report)
        raise typer.Exit(1 if count else 0)
    say(
        f"{report['frames']:,} frames of 1/{report['tick_rate']} s on {report['boards']:,} boards "
        f"({report['table']}, seed {report['seed']}), {report['frames_per_second'] / 1e6:.2f} million/s"
    )
    say(
        f"{report['balls_created']:,} balls, {report['hits']:,} hits, {report['jams']:,} jams; "
        f"deepest penetration {report['deepest_penetration']:.3g} u"
    )
    say(", ".join(f"{kind} {number:,}" for kind, number in report["findings"].items()))
    for name in report["files"][:SHOWN_FINDINGS]:
        say(f"  silverball simulate --soak --again {name}")
    say(f"kept in {report['progress']}")
    raise typer.Exit(1 if count else 0)


def soak_again(path: Path, as_json: bool) -> NoReturn:
    """Do a finding again and say whether it happens; exit code 1 if it does."""
    from silverball.cli.console import compiling

    with compiling("watched_tick"):
        from silverball.soak.checks import Found
        from silverball.soak.finding import Finding, reproduce

        finding = Finding.load(path)
        try:
            found = reproduce(finding)
        except StateError as error:
            raise StateError(f"{path}: {error}") from None
    happens = found.name.lower() == finding.kind
    if as_json:
        report = {"kind": finding.kind, "found": found.name.lower(), "happens_again": happens}
        say_json(report)
    elif happens:
        say(f"{path}: the {finding.kind} of ball {finding.ball} happens again")
    elif found != Found.NOTHING:
        say(f"{path}: instead of the {finding.kind} there is now: {found.name.lower()}")
    else:
        say(f"{path}: the {finding.kind} does not happen any more")
    raise typer.Exit(0 if found == Found.NOTHING else 1)
