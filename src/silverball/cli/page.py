"""`silverball page`: writes a table, or a replay, as one HTML file for any browser."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from silverball.cli.browser_page import ENDING, make_game_page, make_replay_page
from silverball.cli.completion import complete_player, complete_replay, complete_table
from silverball.cli.console import compiling, progress_bar
from silverball.cli.shared_options import (
    LAST_SEED,
    Force,
    Size,
    ThemeName,
    check_output,
    file_name,
    theme_named,
)
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay
    from silverball.table import Table

SEED = 7  # of the board and the game, as in `silverball demo`
SECONDS = 30.0  # of a game that a player plays
DEFAULT_TABLE = "silver_comet"


def page(
    out: Annotated[
        Path | None,
        typer.Option(parser=file_name, metavar="FILE", help="File to write, .html. [default: pinball.html]"),
    ] = None,
    table: Annotated[
        str | None,
        typer.Option(
            help=f"Built-in table or table file. [default: {DEFAULT_TABLE}]", autocompletion=complete_table
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(min=0, max=LAST_SEED, help=f"Seed of the board and of the game. [default: {SEED}]"),
    ] = None,
    replay: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Replay to show, or `last`.", autocompletion=complete_replay),
    ] = None,
    player: Annotated[
        str | None,
        typer.Option(
            help="Player of a game to show, such as planner or trained.", autocompletion=complete_player
        ),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(min=1.0, max=600.0, help=f"Length of that game [s]. [default: {SECONDS:g}]"),
    ] = None,
    size: Size = None,
    theme: ThemeName = "neon",
    force: Force = False,
) -> None:
    """Write a table as one HTML file that anybody can play in a browser, without a server or a network.

    The page computes the same bits as Silverball. With --replay or --player it shows a recorded game
    and compares the digests of every second.

    Example: `silverball page --table classic --out classic.html`
    """
    _refuse_contradictions(replay, table, seed, player, seconds)
    path = out or Path("pinball.html")
    check_output(path, (ENDING,), force=force)
    theme_named(theme)
    if replay is not None:
        from silverball.cli.replay import load

        make_replay_page(path, load(replay), size, theme)
        return
    chosen_seed = SEED if seed is None else seed
    board = _board(DEFAULT_TABLE if table is None else table, chosen_seed)
    if player is None:
        make_game_page(path, board, chosen_seed, size, theme)
    else:
        shown = _played(board, chosen_seed, player, SECONDS if seconds is None else seconds)
        make_replay_page(path, shown, size, theme)


def _refuse_contradictions(
    replay: str | None, table: str | None, seed: int | None, player: str | None, seconds: float | None
) -> None:
    """Refuse options that say nothing about what is written.

    Raises:
        SilverballError: There are such options.
    """
    others = {"--table": table, "--seed": seed, "--player": player}
    given = [name for name, value in others.items() if value is not None]
    if replay is not None and given:
        raise SilverballError(f"--replay brings its own game; leave {' and '.join(given)} out")
    if seconds is not None and player is None:
        raise SilverballError("--seconds is the length of the game of a --player; name one, or leave it out")


def _board(name: str, seed: int) -> Table:
    """The finished table of a name or a file."""
    with compiling():
        from silverball.table import generate_table, load_table

    board = load_table(name)
    return board if board.random is None else generate_table(seed, board)


def _played(board: Table, seed: int, player: str, seconds: float) -> Replay:
    """Let a player play a game, and return its replay."""
    from silverball.players import make_player

    chosen = make_player(player, seed)
    kernel, duration = (
        ("plan_worlds", "half a minute") if player == "planner" else ("step_single_world", "ten seconds")
    )
    with compiling(kernel, duration):
        from silverball.app.controls import PaddleInput
        from silverball.app.sessions import DemoSession

        idle = PaddleInput((False, False), (False, False))  # a demo ignores it
        session = DemoSession(board, seed, chosen)
        chosen.press(session.game.world)
    rate = session.game.tick_rate
    with progress_bar() as bar:
        for _ in bar.track(range(round(seconds)), description="playing"):
            session.advance(idle, rate)
    return session.game.replay
