"""`silverball feel`: measures how a table plays, from thousands of games."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from silverball.cli.console import compiling, print_json, print_lines, print_table, progress_bar
from silverball.cli.shared_options import AsJson, FirstSeed, TableName
from silverball.plain import plain

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from silverball.metrics.feel import Feel

# Figures with an interval, in the order of the report: label and format.
ROWS = {
    "seconds_per_ball": ("seconds per ball", "{:.1f}"),
    "points_per_minute": ("points per minute", "{:,.0f}"),
    "points_per_ball": ("points per ball", "{:,.0f}"),
    "hits_per_second": ("hits per second", "{:.2f}"),
    "cylinder_hits_per_minute": ("cylinder hits per minute", "{:.1f}"),
    "prism_hits_per_minute": ("prism hits per minute", "{:.1f}"),
    "strikes_per_minute": ("strikes per minute", "{:.1f}"),
    "strikes_to_top": ("strikes that reach the top", "{:.1%}"),
    "strikes_to_a_cylinder": ("strikes that reach a cylinder", "{:.1%}"),
    "share_above_half_cap": ("time above half the speed cap", "{:.1%}"),
    "share_on_a_paddle": ("time on a paddle", "{:.2%}"),
    "share_stuck": ("games with a ball stuck over 5 s", "{:.2%}"),
    "share_without_cylinder": ("games that hit no cylinder", "{:.1%}"),
}
# Times [s] without an interval.
SECONDS = {
    "median_game": "median game",
    "p95_game": "95 % of games are shorter than",
    "longest_game": "longest game",
    "longest_stay": "longest stay within half a unit",
    "longest_without_points": "longest time without points",
    "p95_between_hits": "95 % of hits follow within",
}

SHOWN_PARTS = 3  # of the parts that shots hit first


def feel(
    table: TableName = "classic",
    seed: FirstSeed = 0,
    games: Annotated[int, typer.Option(min=2, max=100_000, help="Games of one ball for each player.")] = 1000,
    as_json: AsJson = False,
) -> None:
    """Measure how a table plays: ball times, scores, shots and dead places, with 95 % intervals.

    Four players play it: idle, random, a beginner and reflex. The same options give the same figures.

    Example: `silverball feel --table classic --games 1000`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    with compiling("play_balls"):
        from silverball.metrics.feel import measure

        measure(load_table("classic"), 1, players=("idle",))
    with progress_bar() as bar:
        tasks: dict[str, Any] = {}

        def advance(name: str, done: float) -> None:
            if name not in tasks:
                tasks[name] = bar.add_task(name, total=1.0)
            bar.update(tasks[name], completed=done)

        measured = measure(loaded, games, seed, progress=advance)
    report = {"table": table, "seed": seed, "games": games, **build_report(measured)}
    if as_json:
        print_json(report)
    else:
        print_report(report)


def build_report(feel: Feel) -> dict[str, Any]:
    """The figures for JSON: [value, low, high] each, None for a missing value."""
    from silverball.metrics.feel import hot_cells, shots_as_dict

    players = {
        name: {
            **{key: [finite(part) for part in figure] for key, figure in found.figures.items()},
            "seconds": {key: finite(value) for key, value in found.longest.items()},
            "longest_stay_at": list(found.longest_stay_at),
            "longest_stays_x_z_seconds": [list(cell) for cell in hot_cells(found, feel.table)],
            "cut_short": found.cut_short,
            "strikes_to_cylinders": {
                key: [finite(part) for part in figure] for key, figure in found.cylinders.items()
            },
        }
        for name, found in feel.players.items()
    }
    return {"players": players, "shots": [shots_as_dict(shots) for shots in feel.shots]}


def finite(value: float) -> float | None:
    """The value, or None if it is infinite or NaN, which JSON cannot hold."""
    return float(value) if math.isfinite(value) else None


def print_report(report: dict[str, Any]) -> None:
    """Print the report as tables: the figures, the cylinders that strikes reach, and the shots."""
    print_lines(f"{report['table']}: {report['games']:,} games of one ball per player, seed {report['seed']}")
    print_table(figures_table(report["players"]))
    cylinders = cylinders_table(report["players"])
    if cylinders.row_count:
        print_table(cylinders)
    if report["shots"]:
        print_table(shots_table(report["shots"]))


def new_table(title: str, first: str, columns: list[str]) -> RichTable:
    """An empty table: the first column names the row, the others hold figures."""
    from rich import box
    from rich.table import Table

    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column(first, no_wrap=True)
    for name in columns:
        table.add_column(name, justify="right")
    return table


def figures_table(players: dict[str, Any]) -> RichTable:
    """The figures of every player, one column each."""
    table = new_table("Figures, ± 95 %", "figure", list(players))
    for key, (words, form) in ROWS.items():
        table.add_row(words, *(interval(one[key], form) for one in players.values()))
    for key, words in SECONDS.items():
        seconds = (one["seconds"][key] for one in players.values())
        table.add_row(f"{words} \\[s]", *("–" if cell is None else f"{cell:.1f}" for cell in seconds))
    table.add_row("games cut short", *(str(one["cut_short"]) for one in players.values()))
    return table


def cylinders_table(players: dict[str, Any]) -> RichTable:
    """The share of struck balls that reach each cylinder, by player."""
    from rich.text import Text

    table = new_table("Struck balls that reach a cylinder", "cylinder", list(players))
    for part in next(iter(players.values()))["strikes_to_cylinders"]:
        shares = (one["strikes_to_cylinders"][part] for one in players.values())
        table.add_row(Text(plain(part)), *(interval(share, "{:.1%}") for share in shares))
    return table


def shots_table(shots: list[dict[str, Any]]) -> RichTable:
    """The shots of each paddle: a row for every paddle and direction of the ball."""
    from rich.text import Text

    aims = list(shots[0]["windows_ms"])
    columns = [*(f"{aim} \\[ms]" for aim in aims), "directions \\[°]", "within 10°", "reach the top"]
    table = new_table("Shots: longest windows of the press, and where they go", "paddle, ball", columns)
    table.add_column("hit first, most often")
    for shot in shots:
        name = f"{shot['paddle']}, {shot['way']}"
        if shot["directions_deg"] is None:
            table.add_row(name, "none")
            continue
        low, high = shot["directions_deg"]
        first = sorted(shot["first_met"].items(), key=lambda item: -item[1])
        table.add_row(
            name,
            *(f"{shot['windows_ms'][aim]:.0f}" for aim in aims),
            f"{low:.0f} to {high:.0f}",
            f"{shot['bunched_in_10_deg']:.0%}",
            f"{shot['share_to_top']:.0%}",
            Text(", ".join(f"{plain(part)} {count}" for part, count in first[:SHOWN_PARTS])),
        )
    return table


def interval(figure: list[float | None], form: str) -> str:
    """A figure with the half width of its interval; a dash for a missing value."""
    value, low, high = figure
    if value is None or low is None or high is None:
        return "–"
    return f"{form.format(value).removesuffix('%')} ± {form.format(max(high - value, value - low))}"
