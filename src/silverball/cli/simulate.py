"""`silverball simulate`: many seconds of play without a window."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from silverball.cli.given import given_by
from silverball.cli.say import say, say_json

if TYPE_CHECKING:
    from rich.progress import Progress

    from silverball.table import Table

# What stands for an option of a soak that was not given, and which options belong to one kind of run alone.
SOAK_DEFAULTS = {"table": "random", "worlds": 256, "tick_rate": 60}
SOAK_ONLY = ("frames", "hostile", "progress", "again")
PLAY_ONLY = ("seconds", "player", "balls", "audit", "ball_time")
FEEL_ONLY = ("games",)
NOT_FEEL = (*PLAY_ONLY, *SOAK_ONLY, "soak", "worlds", "tick_rate")


def simulate(
    ctx: typer.Context,
    table: str = typer.Option("classic", help="A built-in table or a table file (of a soak: random)."),
    seed: int = typer.Option(
        0, min=0, max=2**63 - 1_000_001, help="Of the board and of everything random on it."
    ),
    seconds: float = typer.Option(60.0, min=0.01, max=1e9, help="To simulate in each world."),
    player: str = typer.Option(
        "reflex", help="idle, random, reflex, hold, planner, trained or a registered player."
    ),
    worlds: int = typer.Option(1, min=1, max=1_000_000, help="Worlds side by side (of a soak: 256)."),
    balls: int = typer.Option(1, min=1, max=2, help="Balls to keep on the board, if the table allows them."),
    tick_rate: int = typer.Option(
        240, min=10, max=100_000, help="Ticks per simulated second (of a soak: 60)."
    ),
    audit: bool = typer.Option(
        True, help="Check every tick, independently of the solver, for a ball inside anything."
    ),
    as_json: bool = typer.Option(False, "--json", help="Print one JSON object."),
    ball_time: bool = typer.Option(
        False,
        "--ball-time",
        help="How long does a ball live? Watch one in each world, for --seconds at most.",
    ),
    soak: bool = typer.Option(
        False, "--soak", help="Try to break the solver: random boards, presses and speeds; 1 if it breaks."
    ),
    frames: int = typer.Option(10_000_000, min=1, help="Soak until so many frames are done, in all runs."),
    hostile: bool = typer.Option(False, "--hostile", help="Soak boards that break every rule."),
    progress: Path = typer.Option(None, help="File of a soak's progress [default: in the data folder]."),
    again: Path = typer.Option(None, help="File of a finding: does it still happen?"),
    feel: bool = typer.Option(
        False, "--feel", help="How does the table play? Ball times, shots, liveliness, with 95 % intervals."
    ),
    games: int = typer.Option(1000, min=2, max=100_000, help="Games of one ball for each player, to feel."),
) -> None:
    """Let a player play without a window and say what came of it; soak the solver; or feel how a table plays.

    Example: `silverball simulate --table random --seed 7 --seconds 600 --player reflex --json`

    Example: `silverball simulate --ball-time --table random --worlds 1000 --player reflex`

    Example: `silverball simulate --soak --frames 1000000000`

    Example: `silverball simulate --feel --table classic --games 1000`
    """
    given = given_by(ctx)
    refuse_what_does_not_fit(given, soak, feel)
    if feel:
        from silverball.cli.feel import run_feel

        run_feel(table, seed, games, as_json)
        return
    if soak:
        from silverball.cli.soak import print_soak, run_soak, soak_again

        if again is not None:
            soak_again(again, as_json)
        chosen = {name: ctx.params[name] if name in given else SOAK_DEFAULTS[name] for name in SOAK_DEFAULTS}
        print_soak(run_soak(**chosen, seed=seed, hostile=hostile, frames=frames, progress=progress), as_json)
    from rich.progress import Progress

    from silverball.cli.console import compiling, errors
    from silverball.errors import SilverballError
    from silverball.players.registry import check_name
    from silverball.table import load_table

    if not seconds * tick_rate >= 1.0:  # also refuses what is no number
        raise SilverballError(
            f"--seconds: {seconds:g} s is less than one tick of 1/{tick_rate} s; ask for more"
        )
    check_name(player)
    loaded = load_table(table)
    if ball_time:
        from silverball.cli.ball_time import print_ball_times, time_of_balls

        if {"balls", "audit"} & given:
            raise SilverballError("silverball simulate: --balls and --audit do not go with --ball-time")
        print_ball_times(time_of_balls(loaded, table, seed, seconds, player, worlds, tick_rate), as_json)
        return
    with compiling("plan_worlds" if player == "planner" else "play_worlds"):
        from silverball.players.rollout import play
        from silverball.world import WorldBatch

        play(WorldBatch("classic"), "idle", 0.0, 0, audit)
        if player == "planner":
            play(WorldBatch("classic"), player, 1.0 / 60.0, 1, audit)
    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        batch = WorldBatch(boards_of(loaded, seed, worlds, bar), worlds, seed, tick_rate)
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
        "digest": digest_of(batch),
    }
    if as_json:
        say_json(report)
    else:
        print_report(report)


def refuse_what_does_not_fit(given: set[str], soak: bool, feel: bool) -> None:
    """Refuse options that would change nothing."""
    from silverball.errors import SilverballError

    for name in NOT_FEEL if feel else FEEL_ONLY:
        if name in given:
            kind = "does not go with --feel; leave it out" if feel else "needs --feel too"
            raise SilverballError(f"silverball simulate: --{name.replace('_', '-')} {kind}")
    for name in PLAY_ONLY if soak else SOAK_ONLY:
        if name in given:
            kind = "is not for a soak, which presses at random; leave it out" if soak else "needs --soak too"
            raise SilverballError(f"silverball simulate: --{name.replace('_', '-')} {kind}")
    if {"hostile", "table"} <= given:
        raise SilverballError("silverball simulate: --table does not go with --hostile, which makes its own")


def boards_of(loaded: Table, seed: int, worlds: int, bar: Progress) -> list[Table]:
    """A board for each world, showing progress: the same for all, or one for each seed from a recipe."""
    from silverball.table import generate_table

    if loaded.random is None:
        return [loaded] * worlds
    numbers = bar.track(range(seed, seed + worlds), description="making boards")
    return [generate_table(number, loaded) for number in numbers]


def digest_of(batch: Any) -> str:
    """One hash of the states of all worlds."""
    from silverball.world.saved_world import digest

    return digest(batch.state)


def print_report(report: dict[str, Any]) -> None:
    """The report as lines for people."""
    for name, value in report.items():
        if isinstance(value, dict):
            say(f"{name}:")
            for part, count in value.items():
                say(f"  {part:24} {count:>12,}")
        else:
            shown = (
                f"{value:,.6g}"
                if isinstance(value, float)
                else f"{value:,}"
                if isinstance(value, int)
                else value
            )
            say(f"{name.replace('_', ' '):30} {shown}")
