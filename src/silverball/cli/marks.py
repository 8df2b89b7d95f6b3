"""`silverball marks`: whether whole games on a table are as long, and pay as much, as they should."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from silverball.cli.console import compiling, print_json, print_lines, print_table, progress_bar
from silverball.cli.feel import finite, interval, new_table
from silverball.cli.shared_options import AsJson, FirstSeed, TableName
from silverball.errors import SilverballError
from silverball.plain import plain

if TYPE_CHECKING:
    from rich.table import Table

    from silverball.metrics.game_marks import Marks

# Figures of each player, in the order of the report: label and format.
ROWS = {
    "seconds_per_ball": ("seconds a ball, from its launch", "{:.1f}"),
    "points_per_minute": ("points a minute in play", "{:,.0f}"),
    "points_per_game": ("points a game", "{:,.0f}"),
    "share_by_outlane": ("balls lost by an outlane", "{:.1%}"),
    "longest_stay": ("longest stay in one place \\[s]", "{:.1f}"),
    "cut_short": ("games cut short", "{:.1%}"),
}


def marks(
    table: TableName = "silver_comet",
    seed: FirstSeed = 0,
    games: Annotated[
        int, typer.Option(min=2, max=100_000, help="Games of each player but the planner.")
    ] = 1000,
    planner_games: Annotated[
        int, typer.Option(min=0, max=10_000, help="Games of the planner; 0: without it, in a minute.")
    ] = 20,
    as_json: AsJson = False,
) -> None:
    """Measure whole games by a table's rules: ball times, points, drains, shots and missions.

    Five players play it, with 95 % intervals: idle, random, a beginner, reflex, and the planner, which aims.

    Example: `silverball marks --table silver_comet --games 1000`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    if loaded.random is not None:
        raise SilverballError(
            f"{plain(table)}: expected a table, got a recipe for random boards; "
            "write one board with `silverball generate`, and measure that file"
        )
    with compiling("run_games", "some minutes"):
        from silverball.metrics.game_marks import PLAYERS, measure_marks

        players = tuple(name for name in PLAYERS if name != "planner" or planner_games > 0)
        measure_marks(loaded, 2, 2, seed, longest=0.1, players=players)
    with progress_bar() as bar:
        tasks: dict[str, Any] = {}

        def advance(name: str, done: float) -> None:
            if name not in tasks:
                tasks[name] = bar.add_task(f"{name} games", total=1.0)
            bar.update(tasks[name], completed=done)

        measured = measure_marks(loaded, games, planner_games, seed, players=players, progress=advance)
    report = {"table": table, "seed": seed, "games": games, "planner_games": planner_games}
    report |= build_report(measured)
    if as_json:
        print_json(report)
    else:
        print_report(report)


def build_report(measured: Marks) -> dict[str, Any]:
    """The figures for JSON: [value, low, high] each, None for a missing value."""
    found = [
        {
            "name": mark.name,
            "value": [finite(part) for part in mark.value],
            "from": mark.low,
            "to": finite(mark.high),
            "met": mark.is_met,
        }
        for mark in measured.marks
    ]
    players = {
        name: {
            **{key: [finite(part) for part in figure] for key, figure in one.figures.items()},
            "missions": {key: [finite(part) for part in often] for key, often in one.missions.items()},
            "reached": {key: [finite(part) for part in often] for key, often in one.reached.items()},
            "first_seeds": one.seeds,
            "never_hit": list(one.missed),
        }
        for name, one in measured.players.items()
    }
    return {"marks": found, "players": players}


def table_of_reached(players: dict[str, Any]) -> Table:
    """How often each mode ran and each counter grew, and a game in which it was seen."""
    from rich.text import Text

    table = new_table("Games that reached a mode or counter, ± 95 %", "mode", [*players, "seen in"])
    for what in players["idle"]["reached"]:
        seen = [
            (name, one["first_seeds"][what]) for name, one in players.items() if what in one["first_seeds"]
        ]
        example = "none" if not seen else "{}, seed {}".format(*seen[0])
        shares = (interval(one["reached"][what], "{:.1%}") for one in players.values())
        table.add_row(Text(plain(what)), *shares, example)
    return table


def print_report(report: dict[str, Any]) -> None:
    """Print the marks, then the figures and the missions of every player."""
    from rich.text import Text

    games, aimed = report["games"], report["planner_games"]
    print_lines(
        f"{plain(report['table'])}: {games:,} games of each player, {aimed:,} of the planner, "
        f"seed {report['seed']}"
    )
    table = new_table("Marks, ± 95 %", "mark", ["measured", "wanted", "met"])
    for mark in report["marks"]:
        upper = "or more" if mark["to"] is None else f"to {mark['to']:g}"
        wanted = "none" if mark["to"] == 0 else f"{mark['from']:g} {upper}"
        table.add_row(mark["name"], interval(mark["value"], "{:.2f}"), wanted, "yes" if mark["met"] else "no")
    print_table(table)
    players = report["players"]
    table = new_table("Figures, ± 95 %", "figure", list(players))
    for key, (words, form) in ROWS.items():
        table.add_row(words, *(interval(one[key], form) for one in players.values()))
    for name in players["idle"]["missions"]:
        shares = (interval(one["missions"][name], "{:.1%}") for one in players.values())
        table.add_row(Text(f"games that finished {plain(name)}"), *shares)
    print_table(table)
    if players["idle"]["reached"]:
        print_table(table_of_reached(players))
    missed = players["planner"]["never_hit"] if "planner" in players else []
    if missed:
        print_lines(f"Never hit by the planner: {', '.join(map(plain, missed))}")
