"""`silverball ball-time`: measures how long a player keeps a ball in play."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from silverball.cli.console import compiling, make_boards, print_json, print_lines, progress_bar
from silverball.cli.shared_options import (
    AsJson,
    FirstSeed,
    PlayerName,
    Seconds,
    TableName,
    TickRate,
    Worlds,
    check_duration,
)

if TYPE_CHECKING:
    from silverball.metrics.ball_time import BallTimes


def ball_time(
    table: TableName = "classic",
    seed: FirstSeed = 0,
    seconds: Seconds = 60.0,
    player: PlayerName = "reflex",
    worlds: Worlds = 1,
    tick_rate: TickRate = 240,
    as_json: AsJson = False,
) -> None:
    """Measure how long a player keeps a ball in play and how much it scores, with 95 % intervals.

    Each world gets one ball, which is followed until it drains, scores nothing for 15 s, or the time is over.

    Example: `silverball ball-time --table random --worlds 1000 --seconds 600 --player reflex`
    """
    from silverball.players.registry import check_name
    from silverball.table import load_table

    check_duration(seconds, tick_rate)
    check_name(player)
    loaded = load_table(table)
    with compiling("plan_worlds" if player == "planner" else "press_all"):
        from silverball.metrics.ball_time import time_balls
        from silverball.world import WorldBatch

        time_balls(WorldBatch("classic"), player if player == "planner" else "idle", 0.1)
    with progress_bar() as bar:
        batch = WorldBatch(make_boards(loaded, seed, worlds, bar), worlds, seed, tick_rate)
        task = bar.add_task(f"watching {worlds} ball{'s' * (worlds > 1)}", total=seconds)
        times = time_balls(batch, player, seconds, lambda done: bar.update(task, completed=done))
    report = build_report(times) | {
        "table": table, "seed": seed, "player": player, "tick_rate": tick_rate,
    }  # fmt: skip
    if as_json:
        print_json(report)
    else:
        print_report(report)


def build_report(times: BallTimes) -> dict[str, Any]:
    """The figures for JSON; None for a figure that exceeds the watched time."""
    report: dict[str, Any] = {}
    for name, value in times._asdict().items():
        if isinstance(value, tuple):
            report[name], *interval = (number if math.isfinite(number) else None for number in value)
            report[f"{name}_interval"] = interval
        else:
            report[name] = value
    return report


def print_report(report: dict[str, Any]) -> None:
    """Print the report, one figure per line."""
    limit = f"beyond {report['seconds']:g}"

    def formatted(name: str, unit: str, digits: int) -> str:
        numbers = (report[name], *report[f"{name}_interval"])
        value, low, high = (limit if number is None else f"{number:,.{digits}f}" for number in numbers)
        return f"{value} {unit} (95 %: {low} to {high})"

    print_lines(
        f"{report['player']} on {report['table']}: {report['balls']:,} balls, watched for "
        f"{report['seconds']:g} s at most; {report['drained']:,} lost through the gutter, "
        f"{report['stalled']:,} scored nothing for 15 s, {report['alive']:,} alive at the end"
    )
    print_lines(f"median life       {formatted('median', 's', 1)}")
    print_lines(f"mean life so far  {formatted('mean', 's', 1)}")
    print_lines(f"score per ball    {formatted('score', 'points', 0)}")
    print_lines(f"score per minute  {formatted('score_per_minute', 'points', 0)}")
