"""`silverball study`: how a table plays, from thousands of games, as a report."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.progress import Progress, TaskID

from silverball.cli.completion import complete_player, complete_table
from silverball.cli.console import baking, compiling, print_json, print_lines, print_table, progress_bar
from silverball.cli.feel import finite, new_table
from silverball.cli.ray_option import RayAddress, runner_at
from silverball.cli.shared_options import LAST_SEED, AsJson, theme_named
from silverball.errors import SilverballError
from silverball.plain import plain
from silverball.studies.figure_words import COMPARED, ROWS, on_one_line

if TYPE_CHECKING:
    from silverball.studies.run import Runner
    from silverball.studies.study import Study
    from silverball.studies.study_plan import Plan
    from silverball.studies.study_report import WatchedGame

PAGE_HEIGHT = 540  # [pixel] of the games in a report


def study(
    tables: Annotated[
        list[str] | None,
        typer.Argument(
            help="Built-in tables or table files. [default: classic]",
            show_default=False,
            autocompletion=complete_table,
        ),
    ] = None,
    players: Annotated[
        list[str] | None,
        typer.Option(
            "--player",
            help="A player, or beginner; may be given several times. [default: reflex]",
            show_default=False,
            autocompletion=complete_player,
        ),
    ] = None,
    games: Annotated[int, typer.Option(min=2, max=10**9, help="Games of each table and player.")] = 1000,
    seed: Annotated[
        int, typer.Option(min=0, max=LAST_SEED - 10**9, help="Seed of the first game; the next has the next.")
    ] = 0,
    seconds: Annotated[
        float | None,
        typer.Option(
            min=1.0,
            max=36_000.0,
            help="A longer game is cut short. [default: 600, with the planner 120]",
            show_default=False,
        ),
    ] = None,
    sweep: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PATH=FROM:TO:N",
            help="Values for a number of the table, also PATH=VALUE,VALUE; may be given several times.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Where results go. [default: study-… in this folder]"),
    ] = None,
    parquet: Annotated[bool, typer.Option("--parquet", help="Write a row a ball as Parquet files.")] = False,
    events: Annotated[bool, typer.Option("--events", help="The same with a row an event.")] = False,
    ray: RayAddress = None,
    chunk_games: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=1_000_000,
            help="Games of a chunk; more on a large cluster. [default: about a second]",
            show_default=False,
        ),
    ] = None,
    playable: Annotated[
        bool,
        typer.Option(help="Whether the report has the median and the best game; adds some seconds."),
    ] = True,
    as_json: AsJson = False,
) -> None:
    """Study how a table plays: thousands of whole games, figures with 95 % intervals, a report.

    It may be stopped at any time; the same command goes on, and comes to the same figures bit for bit.

    Example: `silverball study classic --games 1000`

    Example: `silverball study classic --sweep paddle.length=1.9:2.3:5 --player beginner`
    """  # fmt: skip
    if parquet or events:
        from silverball.studies.parquet import require_polars

        require_polars()
    plan = make_plan(tables or ["classic"], players or ["reflex"], sweep or [], games, seed, seconds, events)
    plan = plan._replace(chunk_games=chunk_games)
    folder = out or Path(f"study-{folder_name(plan)}")
    measured = play(plan, folder, runner_at(ray, players or ["reflex"]))
    if parquet or events:
        from silverball.studies.parquet import write_parquet

        write_parquet(measured)
    path = write_report(measured, command(), playable)
    if as_json:
        print_json(build_report(measured) | {"folder": str(folder), "report": str(path)})
    else:
        print_report(measured)
        print_lines(f"report: {plain(str(path))}")


def make_plan(
    tables: list[str], players: list[str], sweeps: list[str], games: int, seed: int,
    seconds: float | None, keeps_events: bool,
) -> Plan:  # fmt: skip
    """The plan of the options; everything is checked before the first game.

    Raises:
        SilverballError: A table, player or sweep cannot be used.
    """
    from silverball.players.registry import check_name
    from silverball.studies.study_plan import Plan, arms_of
    from silverball.studies.sweep_arms import swept
    from silverball.studies.table_change import parse_sweep
    from silverball.table import load_table

    for name in players:
        check_name(name, others=("beginner",))
    for what, given in (("table", tables), ("player", players)):
        if len(set(given)) < len(given):
            raise SilverballError(f"silverball study: each {what} once, got {plain(', '.join(given))}")
    arms = arms_of([(name, load_table(name)) for name in tables], players)
    arms = swept(arms, [parse_sweep(text) for text in sweeps])
    return Plan(arms, games, seed, seconds, keeps_events)


def folder_name(plan: Plan) -> str:
    """The default name of the folder of a plan: other plans have other names."""
    import re

    name = re.sub(r"[^a-z0-9]+", "-", plan.arms[0].table.name.lower()).strip("-")[:40] or "table"
    return f"{name}-{plan.digest()[:8]}"


def command() -> str:
    """The command that is running, for the report."""
    import shlex

    return shlex.join(["silverball", *sys.argv[1:]])


def play(plan: Plan, folder: Path, runner: Runner | None = None) -> Study:
    """Play what is missing of a study, with the estimate so far."""
    with compiling("watch_games", "half a minute"):
        from silverball.studies.chunk import run_chunk
        from silverball.studies.run import play_here
        from silverball.studies.study import Study

        run_chunk(next(plan.chunks())._replace(games=1, longest=1.0))
    measured = Study(plan, folder)
    shown = measured.arms[0].games
    try:
        with progress_bar() as bar:
            task = bar.add_task("playing", total=1.0)

            def progress() -> None:
                nonlocal shown
                words = estimate_so_far(measured)
                bar.update(task, completed=measured.done_share, description=words)
                if not shown and measured.arms[0].games:
                    shown = measured.arms[0].games
                    print_lines(f"after {shown:,} games: {words}", err=True)

            measured.run(runner or play_here, progress)
    except KeyboardInterrupt:
        print_lines(f"what is done is in {plain(str(folder))}; the same command goes on from there", err=True)
        raise
    return measured


def estimate_so_far(measured: Study) -> str:
    """What the first arm has come to so far, in a few words."""
    figures = measured.arms[0].figures()
    if not figures:
        return "playing"
    ball, points = (on_one_line(figures[name], "{:,.0f}") for name in COMPARED[:2])
    return f"{plain(measured.plan.arms[0].label)}: {ball} s a ball, {points} points a minute"


def write_report(measured: Study, words: str, playable: bool) -> Path:
    """Write the report of a study into its folder; returns its path."""
    from silverball.studies.result_folder import write_text
    from silverball.studies.study_report import report_page

    path = measured.folder.path / "report.html"
    write_text(path, report_page(measured, words, games_to_watch(measured) if playable else []))
    return path


def games_to_watch(measured: Study) -> list[WatchedGame]:
    """The median and the best game of the first arm, each as a page that plays it."""
    from silverball.studies.played_game import replay_of
    from silverball.studies.study_report import WatchedGame
    from silverball.web.page import replay_page
    from silverball.web.replay_inputs import recording_of

    arm, scores = measured.plan.arms[0], measured.arms[0].scores
    median, best, found = scores.median_game(), scores.best, []
    if median is None or best is None:
        return []
    for title, seed in {"the median game": median, "the best game": best.seed}.items():
        longest = measured.plan.seconds(arm.player)
        with progress_bar() as bar:
            task = bar.add_task(f"recording {title}", total=1.0)
            replay = replay_of(arm.table, arm.player, seed, longest, partial(show_share, bar, task))
        recording = recording_of(replay)
        with baking() as progress:
            page = replay_page(replay, recording, theme_named("clear"), PAGE_HEIGHT, progress=progress)
        words = f"{replay.score:,} points in {replay.ticks / replay.tick_rate:,.0f} s, seed {seed}"
        found.append(WatchedGame(title.capitalize(), words, page))
    return found


def show_share(bar: Progress, task: TaskID, share: float) -> None:
    """Show the share of a task that is done."""
    bar.update(task, completed=share)


def build_report(measured: Study) -> dict[str, Any]:
    """The figures for JSON: [value, low, high] each, None for a missing value."""
    found = {}
    for number, (arm, plan) in enumerate(zip(measured.arms, measured.plan.arms, strict=True)):
        one: dict[str, Any] = {key: [finite(x) for x in figure] for key, figure in arm.figures().items()}
        one |= {
            "hits_per_minute": {row.name: [finite(x) for x in row.figure] for row in arm.hits()},
            "share_of_points": {row.name: [finite(x) for x in row.figure] for row in arm.causes_of_points()},
            "first_met": {row.name: [finite(x) for x in row.figure] for row in arm.first_met()},
            "longest_stay": list(arm.stay),
            "games": arm.games,
            "balls_lost": arm.lost,
            "faults": arm.faults,
        }
        if number:
            one["minus_first"] = {
                key: [finite(x) for x in measured.difference(number, key)] for key in COMPARED
            }
        found[plan.label] = one
    return {"plan": measured.plan.as_dict(), "arms": found}


def print_report(measured: Study) -> None:
    """Print the figures of all arms, and their differences from the first one."""
    from rich.text import Text

    labels = [plain(arm.label) for arm in measured.plan.arms]
    games = measured.plan.games
    print_lines(f"{games:,} games each, seeds {measured.plan.seed:,} to {measured.plan.seed + games - 1:,}")
    faults = sum(arm.faults for arm in measured.arms)
    if faults:
        print_lines(f"{faults:,} games stopped at an impossible state, which is a mistake of Silverball")
    figures = [arm.figures() for arm in measured.arms]
    if len(labels) <= 5:
        table = new_table("Figures, ± 95 %", "figure", [""] * len(labels))
        for column, label in zip(table.columns[1:], labels, strict=True):
            column.header = Text(label)
        for key, (words, form) in ROWS.items():
            table.add_row(Text(words), *(on_one_line(one[key], form) for one in figures))
    else:
        table = new_table("Figures, ± 95 %", "arm", [ROWS[key][0] for key in COMPARED])
        for label, one in zip(labels, figures, strict=True):
            cells = (on_one_line(one[key], ROWS[key][1]) for key in COMPARED)
            table.add_row(Text(label), *cells)
    print_table(table)
    if len(labels) > 1:
        table = new_table(f"Minus {labels[0]}, ± 95 %", "arm", [ROWS[key][0] for key in COMPARED])
        for number, label in enumerate(labels[1:], 1):
            cells = (on_one_line(measured.difference(number, key), ROWS[key][1]) for key in COMPARED)
            table.add_row(Text(label), *cells)
        print_table(table)
