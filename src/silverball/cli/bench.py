"""`silverball bench`: measures speed and accuracy, one command for each benchmark."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from silverball.cli.console import (
    compiling,
    error_console,
    print_json,
    print_lines,
    print_table,
    progress_bar,
)
from silverball.cli.shared_options import (
    LAST_SEED,
    AsJson,
    Music,
    PlayerName,
    TableName,
    ThemeName,
    check_output,
    file_name,
    theme_named,
)
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.benchmarks.speed import Figure

MAX_ACTIONS = 300_000_000  # of three bytes each

bench = typer.Typer(help="Measure how fast and how accurate Silverball is on this machine.")

Rounds = Annotated[
    int, typer.Option("--rounds", min=1, max=1000, help="Timed rounds; their median is printed.")
]
BatchWorlds = Annotated[int, typer.Option("--worlds", min=1, max=1_000_000, help="Worlds in the batch.")]


@bench.command()
def step(
    worlds: BatchWorlds = 4096,
    frames: Annotated[int, typer.Option(min=1, max=10_000, help="Frames of 1/60 s per call.")] = 60,
    rounds: Rounds = 9,
    threads: Annotated[int, typer.Option(min=1, max=1024, help="Threads; 1 gives the speed of a core.")] = 1,
    table: TableName = "random",
    as_json: AsJson = False,
) -> None:
    """Measure simulation speed in frames (of 1/60 s) per second, with two balls and random paddles.

    Example: `silverball bench step --threads 2 --json`
    """
    if worlds * frames > MAX_ACTIONS:
        raise SilverballError(
            f"--worlds {worlds} times --frames {frames} are more actions than fit into memory; "
            f"their product must be at most {MAX_ACTIONS:,}"
        )
    with compiling():
        from silverball.benchmarks.speed import measure
        from silverball.table import load_table

        loaded = load_table(table)
    with error_console.status("measuring …"):
        report: dict[str, Any] = measure(loaded, worlds, frames, rounds, threads)._asdict()
    if as_json:
        print_json(report)
        return
    print_lines(
        f"{report['frames_per_second'] / 1e6:.2f} million frames/s on {report['threads']} thread(s), "
        f"the median of {report['rounds']} rounds (slowest {report['slowest'] / 1e6:.2f}, "
        f"fastest {report['fastest'] / 1e6:.2f})"
    )
    print_lines(
        f"a frame is 1/60 s of one world with {report['balls']:.2f} balls and random paddles; "
        f"{worlds} worlds, {frames} frames per call, {report['boards']} board(s)"
    )
    print_lines(
        f"{report['machine']}; Python {report['python']}, numba {report['numba']}, numpy {report['numpy']}"
    )


@bench.command()
def marks(rounds: Rounds = 9, as_json: AsJson = False) -> None:
    """Measure speed in each situation that could be slow, single calls, and the start (1 to 2 minutes).

    Example: `silverball bench marks`
    """
    with compiling():
        from silverball.benchmarks.step_costs import measure_step_costs
    show_figures(lambda advance: measure_step_costs(rounds, advance), as_json)


@bench.command()
def drawing(rounds: Rounds = 9, as_json: AsJson = False) -> None:
    """Measure how fast tables are baked and frames are drawn (a minute).

    Example: `silverball bench drawing --rounds 5`
    """
    with compiling():
        from silverball.benchmarks.drawing import measure_drawing
    show_figures(lambda advance: measure_drawing(rounds, advance), as_json)


@bench.command()
def planner(
    table: TableName = "classic",
    seed: Annotated[int, typer.Option(min=0, max=LAST_SEED, help="Seed of the game.")] = 3,
    seconds: Annotated[float, typer.Option(min=0.1, max=86_400.0, help="Length of the game [s].")] = 45.0,
    branches: Annotated[
        int | None, typer.Option(min=1, max=1000, help="Branches per decision. [default: the planner's own]")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Measure what a decision of the planner costs at 240 ticks per second.

    Example: `silverball bench planner --table random`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    with compiling("plan_worlds"):
        from silverball.benchmarks.decision_cost import measure_planner
    show_figures(lambda advance: measure_planner(loaded, seed, seconds, branches, advance), as_json)


@bench.command()
def rules(
    worlds: BatchWorlds = 4096,
    rounds: Annotated[int, typer.Option(min=1, max=100_000, help="Rounds of six timed frames.")] = 100,
    table: TableName = "silver_comet",
    as_json: AsJson = False,
) -> None:
    """Measure what the rules of games add to the time of a frame, at 240 ticks per second.

    Example: `silverball bench rules --table classic`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    with compiling("run_games"):
        from silverball.benchmarks.rules_cost import measure_rules
    show_figures(lambda advance: measure_rules(loaded, worlds, rounds, advance=advance), as_json)


@bench.command()
def replays(
    minutes: Annotated[
        float,
        typer.Option(min=0.1, max=1440.0, help="Length of the replay used to time seeks [min]."),
    ] = 60.0,
    as_json: AsJson = False,
) -> None:
    """Measure the size of replays, the speed of verifying them, and the time of a seek.

    Example: `silverball bench replays --minutes 10`
    """
    with compiling():
        from silverball.benchmarks.replays import measure_replays
    show_figures(lambda advance: measure_replays(minutes, advance), as_json)


@bench.command()
def window(
    seconds: Annotated[
        float, typer.Option(min=1.0, max=3600.0, help="Length of the measurement [s].")
    ] = 60.0,
    player: Annotated[
        str | None, typer.Option(help="Watch this player in attract mode instead: planner or reflex.")
    ] = None,
    table: TableName = "random",
    size: Annotated[
        tuple[int, int] | None,
        typer.Option(min=1, max=8192, metavar="WIDTH HEIGHT", help="Size of the window [pixel]."),
    ] = None,
    is_arcade: Annotated[
        bool, typer.Option("--arcade", help="Play arcade games with their rules instead of free play.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Measure frame rate, input latency and start-up of the real window, which opens and plays by itself.

    For a first start, set SILVERBALL_CACHE to an empty folder. Without a display, run it under `xvfb-run -a`.

    Example: `silverball bench window --seconds 20 --arcade --table silver_comet --size 1920 1080`
    """
    from silverball.benchmarks.window_smoothness import measure_window

    show_figures(lambda advance: measure_window(seconds, player, advance, table, size, is_arcade), as_json)


@bench.command("page")
def page_(
    table: TableName = "silver_comet",
    size: Annotated[
        tuple[int, int],
        typer.Option(min=100, max=8192, metavar="WIDTH HEIGHT", help="Size of the browser's window [pixel]."),
    ] = (1280, 900),
    pictures: Annotated[int, typer.Option(min=2, max=100_000, help="Pictures that are timed.")] = 600,
    as_json: AsJson = False,
) -> None:
    """Measure the page of a table in Chromium: its start, pictures per second, and the work of a picture.

    Example: `silverball bench page --table classic --size 390 844`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    with compiling():
        from silverball.benchmarks.page_smoothness import measure_page
    show_figures(lambda advance: measure_page(loaded, size, pictures, advance), as_json)


@bench.command()
def sound(
    table: TableName = "silver_comet",
    seed: Annotated[int, typer.Option(min=0, max=LAST_SEED, help="Seed of the game.")] = 3,
    seconds: Annotated[float, typer.Option(min=1.0, max=3600.0, help="Length of the game [s].")] = 60.0,
    player: PlayerName = "reflex",
    theme: ThemeName = "neon",
    music: Music = True,
    out: Annotated[
        Path | None,
        typer.Option(parser=file_name, metavar="FILE.wav", help="File for the recording."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Measure the sound of an arcade game: loudness, peaks, and the level of every octave.

    Example: `silverball bench sound --table parts --out parts.wav`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    theme_named(theme)  # an unknown one is refused
    if out is not None:
        check_output(out, (".wav",), force=True)
    with compiling():
        from silverball.benchmarks.sound_levels import Recording, measure_sound
    recording = Recording(loaded, seed, seconds, player, theme, has_music=music)
    show_figures(lambda advance: measure_sound(recording, out, advance), as_json)


@bench.command()
def thresholds(
    episodes: Annotated[
        int, typer.Option(min=2, max=1_000_000, help="Episodes played in each environment.")
    ] = 2000,
    as_json: AsJson = False,
) -> None:
    """Measure the return of the trained player: the threshold for counting an environment as solved.

    Example: `silverball bench thresholds --episodes 2000`
    """
    with compiling():
        from silverball.benchmarks.thresholds import measure_thresholds
    show_figures(lambda advance: measure_thresholds(episodes, advance), as_json)


@bench.command()
def domain(
    board: Annotated[str, typer.Option(help="A built-in board, or a .cfg file.")] = "open",
    rounds: Rounds = 5,
    as_json: AsJson = False,
) -> None:
    """Measure the PinBall domain on the exact engine, and its published rules in NumPy.

    Example: `silverball bench domain --board rooms`
    """
    with compiling():
        from silverball.benchmarks.domain_speed import measure_domain
    show_figures(lambda advance: measure_domain(board, rounds, advance), as_json)


@bench.command()
def shots(
    table: Annotated[str, typer.Option(help="A table with shots: classic or silver_comet.")] = "classic",
    episodes: Annotated[int, typer.Option(min=2, max=1_000_000, help="Episodes of each player.")] = 1000,
    as_json: AsJson = False,
) -> None:
    """Measure how often simple players hit the wanted part next, and the best press that there is.

    Example: `silverball bench shots --table silver_comet --episodes 300`
    """
    with compiling():
        from silverball.benchmarks.shot_rates import measure_shots
    show_figures(lambda advance: measure_shots(table, episodes, advance), as_json)


@bench.command()
def envs(
    rounds: Rounds = 9,
    out: Annotated[
        list[str], typer.Option(metavar="FILE.md", help="Markdown table to write; may be repeated.")
    ] = [],  # noqa: B006  (typer copies it)
    as_json: AsJson = False,
) -> None:
    """Measure the environments for agents, and those of other packages that are installed, for comparison.

    Example: `silverball bench envs --rounds 5 --out envs.md`
    """
    from silverball.benchmarks.envs import measure, rate_table
    from silverball.wholefile import write_whole

    paths = [output_path(text, (".md",)) for text in out]
    with progress_bar() as bar:
        task = bar.add_task("compiling …", total=None)
        result = measure.run(rounds, lambda doing: bar.update(task, description=doing))
    if as_json:
        print_lines(*rate_table.as_json(result).splitlines())
    else:
        print_table(rate_table.terminal_table(result))
        print_lines(*rate_table.footer(result))
    for path in paths:
        write_whole(
            path, lambda temporary: temporary.write_text(rate_table.markdown(result), encoding="utf-8")
        )
        print_lines(f"wrote {path}", err=True)


@bench.command()
def peers(
    worlds: BatchWorlds = 4096,
    rounds: Rounds = 9,
    table: TableName = "random",
    quick: Annotated[
        bool, typer.Option("--quick", help="Rough figures in ten seconds instead of four minutes.")
    ] = False,
    out: Annotated[
        list[str],
        typer.Option(metavar="FILE.png|.md", help="Plot or Markdown table to write; may be repeated."),
    ] = [],  # noqa: B006  (typer copies it)
    as_json: AsJson = False,
) -> None:
    """Compare speed and accuracy with pymunk and Box2D on the same tables, on one core.

    Example: `silverball bench peers --out peers.png --out peers.md`
    """
    from silverball.benchmarks.peers.engines import PEERS, installed_peers
    from silverball.table import load_table

    paths = [output_path(text, (".png", ".md")) for text in out]
    loaded = load_table(table)
    if not loaded.paddle:
        raise SilverballError(f"--table {table}: the comparison needs paddles, and this table has none")
    engines = installed_peers()
    for engine in PEERS:
        if engine not in engines:
            error_console.print(engine.install_hint)
    with compiling():
        from silverball.benchmarks.peers import comparison, report
        from silverball.wholefile import write_whole

        if any(path.suffix.lower() == ".png" for path in paths):
            report.require_matplotlib()
    plan = comparison.Plan(worlds=worlds, rounds=rounds)
    if quick:
        plan = plan.shortened()
    with progress_bar() as bar:
        task = bar.add_task("", total=comparison.units(plan, engines))

        def advance(doing: str) -> None:
            bar.update(task, advance=1, description=doing)

        result = comparison.run(loaded, plan, engines, advance)
    if as_json:
        print_lines(*report.as_json(result).splitlines())
    else:
        print_table(report.terminal_table(result))
        print_lines(*report.conclusions(result), *report.footer(result))
    for path in paths:
        if path.suffix.lower() == ".png":
            write_whole(path, lambda temporary: report.draw_plot(result, temporary))
        else:
            write_whole(
                path, lambda temporary: temporary.write_text(report.markdown(result), encoding="utf-8")
            )
        print_lines(f"wrote {path}", err=True)


def show_figures(measure: Callable[[Callable[[str], None]], list[Figure]], as_json: bool) -> None:
    """Run a measurement with a progress bar that names its current part, and print the figures."""
    from silverball.benchmarks.speed import machine

    with progress_bar() as bar:
        task = bar.add_task("", total=None)
        figures = measure(lambda doing: bar.update(task, description=doing))
    if as_json:
        print_json([figure._asdict() for figure in figures])
        return
    for figure in figures:
        print_lines(f"{figure.name:44} {figure.value:10.4g} {figure.unit}")
    print_lines(machine())


def output_path(text: str, suffixes: tuple[str, ...]) -> Path:
    """The path of a report, checked for its suffix, which selects the format.

    Raises:
        OutputError: The suffix is not one of `suffixes`, or the folder does not exist.
    """
    path = file_name(text)
    check_output(path, suffixes, force=True)
    return path
