"""`silverball soak`: searches for faults of the solver on random boards."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from silverball.cli.completion import complete_table
from silverball.cli.console import compiling, print_json, print_lines, progress_bar
from silverball.cli.ray_option import RayAddress, rounds_at
from silverball.cli.shared_options import AsJson, FirstSeed, TickRate, Worlds
from silverball.errors import SilverballError, StateError

if TYPE_CHECKING:
    from silverball.soak.campaign import RoundSource

SHOWN_FINDINGS = 10


def soak(
    table: Annotated[
        str | None,
        typer.Option(
            help="Built-in table or table file; not with --hostile.",
            show_default="random, and boards of all parts",
            autocompletion=complete_table,
        ),
    ] = None,
    seed: FirstSeed = 0,
    frames: Annotated[
        int, typer.Option(min=1, help="Total frames to reach, including those of earlier runs.")
    ] = (10_000_000),
    worlds: Worlds = 256,
    tick_rate: TickRate = 60,
    hostile: Annotated[
        bool, typer.Option("--hostile", help="Use boards that violate the rules of tables.")
    ] = False,
    progress: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Progress file. [default: a file in the data folder]"),
    ] = None,
    again: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Repeat a finding instead, and report whether it still happens."),
    ] = None,
    ray: RayAddress = None,
    as_json: AsJson = False,
) -> None:
    """Try to break the solver: random boards, buttons and speeds, every tick checked independently.

    An interrupted soak continues where it stopped. Each finding is written to a file that --again repeats.

    Exit codes: 0 nothing found, 1 a finding.

    Example: `silverball soak --frames 1000000000`
    """
    if again is not None:
        repeat(again, as_json)
    if hostile and table is not None:
        raise SilverballError("silverball soak: --table does not go with --hostile, which makes its own")
    report = run_soak(table, seed, worlds, tick_rate, hostile, frames, progress, rounds_at(ray))
    if as_json:
        print_json(report)
    else:
        print_report(report)
    raise typer.Exit(1 if any(report["findings"].values()) else 0)


def run_soak(
    table: str | None,
    seed: int,
    worlds: int,
    tick_rate: int,
    hostile: bool,
    frames: int,
    progress: Path | None,
    rounds: RoundSource | None = None,
) -> dict[str, Any]:
    """Soak until the total of frames is reached; returns the report."""
    from silverball.game.user_folder import data_folder
    from silverball.table import load_table

    parts, table = table is None, "random" if table is None else table
    recipe = load_table(table)
    with compiling("soak_worlds"):
        from silverball.soak import campaign
        from silverball.soak.rounds import Options, SoakBatch

        options = Options(recipe, seed, worlds, tick_rate, hostile, hostile or parts)
        path = progress or data_folder() / "soak" / campaign.log_name(options)
        earlier = campaign.load_or_begin(options, path)
        SoakBatch([load_table("classic")], [seed], tick_rate, hostile).run(1)
    started = time.perf_counter()
    try:
        with progress_bar() as bar:
            task = bar.add_task(f"soaking {frames:,} frames", total=frames, completed=earlier.totals.frames)
            log = campaign.soak(options, frames, path, lambda done: bar.update(task, completed=done), rounds)
    except KeyboardInterrupt:
        print_lines(f"progress is saved in {path}; the same command continues from there", err=True)
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


def print_report(report: dict[str, Any]) -> None:
    """Print the report in a few lines."""
    print_lines(
        f"{report['frames']:,} frames of 1/{report['tick_rate']} s on {report['boards']:,} boards "
        f"({report['table']}, seed {report['seed']}), {report['frames_per_second'] / 1e6:.2f} million/s"
    )
    print_lines(
        f"{report['balls_created']:,} balls, {report['hits']:,} hits, {report['jams']:,} jams; "
        f"deepest penetration {report['deepest_penetration']:.3g} u"
    )
    print_lines(", ".join(f"{kind} {number:,}" for kind, number in report["findings"].items()))
    for name in report["files"][:SHOWN_FINDINGS]:
        print_lines(f"  silverball soak --again {name}")
    print_lines(f"progress is saved in {report['progress']}")


def repeat(path: Path, as_json: bool) -> NoReturn:
    """Repeat a finding and report whether it still happens; exit code 1 if anything is found.

    Raises:
        StateError: The file is not a finding.
    """
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
        print_json(report)
    elif happens:
        print_lines(f"{path}: the {finding.kind} of ball {finding.ball} happens again")
    elif found != Found.NOTHING:
        print_lines(f"{path}: instead of the {finding.kind}, another finding: {found.name.lower()}")
    else:
        print_lines(f"{path}: the {finding.kind} no longer happens")
    raise typer.Exit(0 if found == Found.NOTHING else 1)
