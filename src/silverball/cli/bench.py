"""`silverball bench`: how fast is the step here, and how does it compare with other engines?"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from silverball.cli.say import say, say_json

if TYPE_CHECKING:
    from silverball.benchmarks.marks import Figure

MOST_ACTIONS = 300_000_000  # three bytes each
ENDINGS = (".png", ".md")


def bench(
    worlds: int = typer.Option(4096, min=1, max=1_000_000, help="Worlds side by side."),
    frames: int = typer.Option(60, min=1, max=10_000, help="Frames of 1/60 s in one call."),
    rounds: int = typer.Option(9, min=1, max=1000, help="Timed calls; the median counts."),
    threads: int = typer.Option(1, min=1, max=1024, help="Threads; 1 gives the speed of one core."),
    table: str = typer.Option("random", help="A built-in table or a table file."),
    peers: bool = typer.Option(
        False, "--peers", help="Play the same table in pymunk and Box2D too; takes some minutes."
    ),
    marks: bool = typer.Option(
        False, "--marks", help="Measure every place where the step could be slow; takes a minute or two."
    ),
    drawing: bool = typer.Option(
        False, "--drawing", help="Measure how fast pictures are made and drawn; takes a minute."
    ),
    envs: bool = typer.Option(
        False, "--envs", help="Measure the environments for agents, and others that are installed."
    ),
    quick: bool = typer.Option(False, "--quick", help="With --peers: a rough look, in ten seconds."),
    out: list[str] = typer.Option(
        [],
        metavar="FILE.png|.md",
        help="With --peers: also write a plot or a Markdown table; with --envs a table; repeatable.",
    ),
    as_json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Measure the speed of the compiled step: frames of 1/60 s, two balls, random paddles.

    Example: `silverball bench --json`, the places where it could be slow with `silverball bench --marks`,
    the drawing with `silverball bench --drawing`, the environments for agents with `silverball bench --envs`,
    or beside other engines with
    `silverball bench --peers --out peers.png --out peers.md`
    """
    from silverball.cli.console import compiling, errors
    from silverball.errors import SilverballError

    if worlds * frames > MOST_ACTIONS:
        raise SilverballError(
            f"--worlds {worlds} times --frames {frames} are more actions than memory should hold; "
            f"keep the product below {MOST_ACTIONS:,}"
        )
    if peers:
        if threads != 1 or frames != 60:
            raise SilverballError(
                "--peers compares on one core, 60 frames a call; leave --threads and --frames out"
            )
        compare(table, worlds, rounds, quick, out, as_json)
        return
    if marks:
        show_marks(rounds, as_json)
        return
    if drawing:
        show_drawing(rounds, as_json)
        return
    if envs:
        show_envs(rounds, out, as_json)
        return
    if quick or out:
        raise SilverballError(
            "--quick belongs to --peers and --out to --peers and --envs; add one of these or leave them out"
        )
    with compiling():
        from silverball.benchmarks.speed import measure
        from silverball.table import load_table

        loaded = load_table(table)
    with errors.status("measuring …"):
        report: dict[str, Any] = measure(loaded, worlds, frames, rounds, threads)._asdict()
    if as_json:
        say_json(report)
        return
    say(
        f"{report['frames_per_second'] / 1e6:.2f} million frames/s on {report['threads']} thread(s), "
        f"the median of {report['rounds']} (slowest {report['slowest'] / 1e6:.2f}, "
        f"fastest {report['fastest'] / 1e6:.2f})"
    )
    say(
        f"a frame is 1/60 s of one world with {report['balls']:.2f} balls and random paddles; "
        f"{worlds} worlds, {frames} frames a call, {report['boards']} board(s)"
    )
    say(f"{report['machine']}; Python {report['python']}, numba {report['numba']}, numpy {report['numpy']}")


def show_marks(rounds: int, as_json: bool) -> None:
    """Measure and show the marks of the step."""
    from silverball.cli.console import compiling

    with compiling():
        from silverball.benchmarks.marks import measure_marks
    show_figures(measure_marks, rounds, as_json)


def show_drawing(rounds: int, as_json: bool) -> None:
    """Measure and show the marks of the drawing."""
    from silverball.cli.console import compiling

    with compiling():
        from silverball.benchmarks.drawing import measure_drawing
    show_figures(measure_drawing, rounds, as_json)


def show_figures(measure: Callable[..., list[Figure]], rounds: int, as_json: bool) -> None:
    """Measure with a bar that says what is measured, and show what came of it."""
    from rich.progress import Progress

    from silverball.benchmarks.speed import machine
    from silverball.cli.console import errors

    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        task = bar.add_task("", total=None)
        figures = measure(rounds, lambda doing: bar.update(task, description=doing))
    if as_json:
        say_json([figure._asdict() for figure in figures])
        return
    for figure in figures:
        say(f"{figure.name:40} {figure.value:8.3g} {figure.unit}")
    say(f"medians of {rounds} rounds; {machine()}")


def show_envs(rounds: int, out: list[str], as_json: bool) -> None:
    """Measure and show the rates of the environments, beside others that are installed."""
    from rich.progress import Progress

    from silverball.benchmarks.envs import measure as contest
    from silverball.benchmarks.envs import table as report
    from silverball.cli.console import errors
    from silverball.wholefile import write_whole

    paths = [output_path(text, (".md",)) for text in out]
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        task = bar.add_task("compiling …", total=None)
        result = contest.run(rounds, lambda doing: bar.update(task, description=doing))
    if as_json:
        say(*report.as_json(result).splitlines())
    else:
        show_table(report.terminal_table(result), report.footing(result))
    for path in paths:
        write_whole(path, lambda place: place.write_text(report.markdown(result), encoding="utf-8"))
        say(f"wrote {path}", err=True)


def show_table(table: Any, lines: list[str]) -> None:
    """Print a table as wide as it is where nobody looks at a screen, and lines below it."""
    from rich.console import Console

    console = Console() if Console().is_terminal else Console(width=200)
    console.print(table)
    say(*lines)


def compare(table: str, worlds: int, rounds: int, quick: bool, out: list[str], as_json: bool) -> None:
    """Let all engines that are installed play the same tables, and show what came of it."""
    from rich.progress import Progress

    from silverball.benchmarks.peers.engines import PEERS, present_peers
    from silverball.cli.console import compiling, errors
    from silverball.errors import SilverballError
    from silverball.table import load_table

    paths = [output_path(text) for text in out]
    loaded = load_table(table)
    if not loaded.paddle:
        raise SilverballError(f"--table {table}: the comparison presses paddles, and this table has none")
    engines = present_peers()
    for engine in PEERS:
        if engine not in engines:
            errors.print(engine.missing)
    with compiling():
        from silverball.benchmarks.peers import comparison as contest
        from silverball.benchmarks.peers import plot, report

        if any(path.suffix == ".png" for path in paths):
            plot.require_matplotlib()
    plan = contest.Plan(worlds=worlds, rounds=rounds)
    if quick:
        plan = plan._replace(
            worlds=min(worlds, 512), rounds=min(rounds, 3), seconds=0.1, calls=1, boards=2, frames=1000,
            scenes=3, energy_seconds=30,
        )  # fmt: skip
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        task = bar.add_task("", total=contest.units(plan, engines))

        def advance(doing: str) -> None:
            bar.update(task, advance=1, description=doing)

        result = contest.run(loaded, plan, engines, advance)
    if as_json:
        say(*report.as_json(result).splitlines())
    else:
        show_table(report.terminal_table(result), [*report.conclusions(result), *report.footing(result)])
    write(paths, result)


def output_path(text: str, endings: tuple[str, ...] = ENDINGS) -> Path:
    """A file to write, whose ending says what."""
    from silverball.cli.output import file_name
    from silverball.errors import OutputError

    path = file_name(text)
    if path.suffix not in endings:
        raise OutputError(
            f"{path}: this comparison is written as {' or '.join(endings)}; choose an ending like that"
        )
    if not path.absolute().parent.is_dir():
        raise OutputError(f"{path}: the folder {path.parent} does not exist; make it first")
    return path


def write(paths: list[Path], result: Any) -> None:
    """Write the plot and the Markdown table."""
    from silverball.benchmarks.peers import plot, report
    from silverball.wholefile import write_whole

    for path in paths:
        if path.suffix == ".png":
            write_whole(path, lambda place: plot.draw(result, place))
        else:
            write_whole(path, lambda place: place.write_text(report.markdown(result), encoding="utf-8"))
        say(f"wrote {path}", err=True)
