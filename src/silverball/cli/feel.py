"""`silverball simulate --feel`: how does a table play? Figures from thousands of games."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from silverball.cli.say import say, say_json

if TYPE_CHECKING:
    from silverball.metrics.feel import Feel

# What each figure is called for people, its unit or format, in the order in which they are printed.
ROWS = {
    "seconds_per_ball": ("seconds per ball", "{:.1f}"),
    "points_per_minute": ("points per minute", "{:,.0f}"),
    "points_per_ball": ("points per ball", "{:,.0f}"),
    "hits_per_second": ("hits per second", "{:.2f}"),
    "cylinder_hits_per_minute": ("hits of cylinders per minute", "{:.1f}"),
    "prism_hits_per_minute": ("hits of prisms per minute", "{:.1f}"),
    "strikes_per_minute": ("strikes per minute", "{:.1f}"),
    "strikes_to_top": ("strikes that reach the top", "{:.1%}"),
    "strikes_to_a_cylinder": ("strikes that reach a cylinder", "{:.1%}"),
    "share_above_half_cap": ("time above half the cap", "{:.1%}"),
    "share_on_a_paddle": ("time on a paddle", "{:.2%}"),
    "share_stuck": ("games with a ball stuck over 5 s", "{:.2%}"),
    "share_without_cylinder": ("games that hit no cylinder", "{:.1%}"),
}
SECONDS = {
    "median_game": "median game",
    "p95_game": "95 % of the games are shorter than",
    "longest_game": "longest game",
    "longest_stay": "longest stay within half a unit",
    "longest_without_points": "longest time without points",
    "p95_between_hits": "95 % of the hits come within",
}


def run_feel(table: str, seed: int, games: int, as_json: bool) -> None:
    """Measure the feel of a table and print it."""
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors
    from silverball.table import load_table

    loaded = load_table(table)
    with compiling("play_balls"):
        from silverball.metrics.feel import measure

        measure(load_table("classic"), 1, players=("idle",))
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        tasks: dict[str, Any] = {}

        def said(what: str, done: float) -> None:
            if what not in tasks:
                tasks[what] = bar.add_task(what, total=1.0)
            bar.update(tasks[what], completed=done)

        feel = measure(loaded, games, seed, progress=said)
    report = {"table": table, "seed": seed, "games": games, **report_of(feel)}
    if as_json:
        say_json(report)
    else:
        say(*lines_of(report))


def report_of(feel: Feel) -> dict[str, Any]:
    """The figures as JSON holds them: [value, low, high] each, null where there is none."""
    from silverball.metrics.feel import hot_cells, shots_as_dict

    players = {
        name: {
            **{key: [plain(part) for part in figure] for key, figure in found.figures.items()},
            "seconds": {key: plain(value) for key, value in found.longest.items()},
            "longest_stay_at": list(found.longest_stay_at),
            "longest_stays_x_z_seconds": [list(cell) for cell in hot_cells(found, feel.table)],
            "cut_short": found.cut_short,
            "strikes_to_cylinders": {
                key: [plain(part) for part in figure] for key, figure in found.cylinders.items()
            },
        }
        for name, found in feel.players.items()
    }
    return {"players": players, "shots": [shots_as_dict(shots) for shots in feel.shots]}


def plain(value: float) -> float | None:
    """A number that JSON has a word for."""
    return float(value) if math.isfinite(value) else None


def lines_of(report: dict[str, Any]) -> list[str]:
    """The report as lines for people."""
    players = report["players"]
    lines = [
        f"{report['table']}: {report['games']:,} games of one ball for each player, seed {report['seed']}"
    ]
    lines += ["", f"{'':36}" + "".join(f"{name:>16}" for name in players)]
    for key, (words, form) in ROWS.items():
        lines.append(f"{words:36}" + "".join(f"{interval(one[key], form):>16}" for one in players.values()))
    for key, words in SECONDS.items():
        cells = (one["seconds"][key] for one in players.values())
        lines.append(f"{words + ' [s]':36}" + "".join(f"{shown(cell, '{:.1f}'):>16}" for cell in cells))
    lines.append(f"{'games cut short':36}" + "".join(f"{one['cut_short']:>16}" for one in players.values()))
    lines += ["", "Of the struck balls, those that reach each cylinder:"]
    for part in next(iter(players.values()))["strikes_to_cylinders"]:
        cells = (one["strikes_to_cylinders"][part] for one in players.values())
        lines.append(f"  {part:34}" + "".join(f"{interval(cell, '{:.1%}'):>16}" for cell in cells))
    for shots in report["shots"]:
        lines += ["", *shot_lines(shots)]
    return lines


def shot_lines(shots: dict[str, Any]) -> list[str]:
    """The lines about one paddle's shots."""
    title = f"Shots of the {shots['paddle']} paddle, ball {shots['way']}:"
    if shots["directions_deg"] is None:
        return [f"{title} none"]
    windows = ", ".join(f"{name} {width:.0f} ms" for name, width in shots["windows_ms"].items())
    low, high = shots["directions_deg"]
    met = sorted(shots["first_met"].items(), key=lambda item: -item[1])
    return [
        title,
        f"  longest windows of the press: {windows}",
        f"  directions {low:.0f} to {high:.0f} deg, {shots['bunched_in_10_deg']:.0%} within 10 deg; "
        f"{shots['share_to_top']:.0%} reach the top by themselves",
        "  first met: " + ", ".join(f"{name} {count}" for name, count in met),
    ]


def interval(figure: list[float | None], form: str) -> str:
    """A figure with its interval, for people."""
    value, low, high = figure
    if value is None or low is None or high is None:
        return "–"
    return f"{form.format(value).removesuffix('%')} ± {form.format(max(high - value, value - low))}"


def shown(value: float | None, form: str) -> str:
    """A number for people, a dash where there is none."""
    return "–" if value is None else form.format(value)
