"""`silverball simulate --ball-time`: how long does a ball live under a player?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from silverball.cli.say import say, say_json

if TYPE_CHECKING:
    from silverball.metrics.ball_time import BallTimes
    from silverball.table import Table


def time_of_balls(
    loaded: Table, table: str, seed: int, seconds: float, player: str, worlds: int, tick_rate: int
) -> dict[str, Any]:
    """Watch one ball in each of some worlds, showing progress; the report."""
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors
    from silverball.cli.simulate import boards_of
    from silverball.metrics.ball_time import time_balls
    from silverball.world import WorldBatch

    with compiling("plan_worlds" if player == "planner" else "press_all"):
        time_balls(WorldBatch("classic"), player if player == "planner" else "idle", 0.1)
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        batch = WorldBatch(boards_of(loaded, seed, worlds, bar), worlds, seed, tick_rate)
        task = bar.add_task(f"watching {worlds} ball{'s' * (worlds > 1)}", total=seconds)
        times = time_balls(batch, player, seconds, lambda done: bar.update(task, completed=done))
    return report_of(times) | {
        "table": table, "seed": seed, "player": player, "tick_rate": tick_rate,
    }  # fmt: skip


def report_of(times: BallTimes) -> dict[str, Any]:
    """The figures under names for a machine; None where a figure lies beyond the time."""
    report: dict[str, Any] = {}
    for name, value in times._asdict().items():
        if isinstance(value, tuple):
            report[name], *interval = (number if math.isfinite(number) else None for number in value)
            report[f"{name}_interval"] = interval
        else:
            report[name] = value
    return report


def print_ball_times(report: dict[str, Any], as_json: bool) -> None:
    """The report, for a machine or for people."""
    if as_json:
        say_json(report)
        return
    limit = f"beyond {report['seconds']:g}"

    def shown(name: str, unit: str, digits: int) -> str:
        numbers = (report[name], *report[f"{name}_interval"])
        value, low, high = (limit if number is None else f"{number:,.{digits}f}" for number in numbers)
        return f"{value} {unit} (95 %: {low} to {high})"

    say(
        f"{report['player']} on {report['table']}: {report['balls']:,} balls, watched for "
        f"{report['seconds']:g} s at most; {report['drained']:,} lost through the gutter, "
        f"{report['stalled']:,} scored nothing for 15 s, {report['alive']:,} alive at the end"
    )
    say(f"median life       {shown('median', 's', 1)}")
    say(f"mean life so far  {shown('mean', 's', 1)}")
    say(f"score of a ball   {shown('score', 'points', 0)}")
    say(f"score a minute    {shown('score_per_minute', 'points', 0)}")
