"""`silverball simulate`: runs worlds without a window and reports what happened in them."""

from __future__ import annotations

from typing import Annotated, Any

import typer

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


def simulate(
    table: TableName = "classic",
    seed: FirstSeed = 0,
    seconds: Seconds = 60.0,
    player: PlayerName = "reflex",
    worlds: Worlds = 1,
    balls: Annotated[
        int, typer.Option(min=1, max=2, help="Balls to keep on the board, as far as the table allows.")
    ] = 1,
    tick_rate: TickRate = 240,
    audit: Annotated[
        bool, typer.Option(help="Check after every tick, independently of the solver, that nothing overlaps.")
    ] = True,
    as_json: AsJson = False,
) -> None:
    """Simulate games without a window and report balls, hits, score and penetration.

    A drained ball is replaced. The digest identifies the final state: the same options give the same digest
    on every machine.

    Example: `silverball simulate --table random --seed 7 --seconds 600 --player reflex --json`
    """
    from silverball.players.registry import check_name
    from silverball.table import load_table

    check_duration(seconds, tick_rate)
    check_name(player)
    loaded = load_table(table)
    with compiling("plan_worlds" if player == "planner" else "play_worlds"):
        from silverball.players.rollout import play
        from silverball.world import WorldBatch
        from silverball.world.saved_world import digest

        play(WorldBatch("classic"), "idle", 0.0, 0, audit)
        if player == "planner":
            play(WorldBatch("classic"), player, 1.0 / 60.0, 1, audit)
    with progress_bar() as bar:
        batch = WorldBatch(make_boards(loaded, seed, worlds, bar), worlds, seed, tick_rate)
        task = bar.add_task(f"simulating {worlds} world{'s' * (worlds > 1)}", total=seconds)
        played = play(batch, player, seconds, balls, audit, lambda done: bar.update(task, completed=done))
    report: dict[str, Any] = {
        "table": table,
        "seed": seed,
        "player": player,
        "worlds": worlds,
        "tick_rate": tick_rate,
        "seconds": played.seconds,
        "balls_created": played.created,
        "balls_drained": played.drained,
        "seconds_per_ball": played.seconds * worlds / played.drained if played.drained else None,
        "score": played.score,
        "hits": played.hits,
        "ball_hits": played.ball_hits,
        "touches": played.touches,
        "jams": played.jams,
        "faults": played.faults,
        "deepest_penetration": played.deepest if audit else None,
        "simulated_seconds_per_second": played.seconds * worlds / played.wall_seconds,
        "digest": digest(batch.state),
    }
    if as_json:
        print_json(report)
    else:
        print_report(report)


def print_report(report: dict[str, Any]) -> None:
    """Print the report, one figure per line."""
    for name, value in report.items():
        if isinstance(value, dict):
            print_lines(f"{name}:")
            for part, count in value.items():
                print_lines(f"  {part:24} {count:>12,}")
        else:
            shown = value
            if isinstance(value, float):
                shown = f"{value:,.6g}"
            elif isinstance(value, int):
                shown = f"{value:,}"
            print_lines(f"{name.replace('_', ' '):30} {shown}")
