"""`silverball demo`: films a game that the program plays by itself."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from silverball.cli.console import baking, compiling
from silverball.cli.shared_options import (
    BoardSeed,
    Force,
    Music,
    PlayerName,
    Size,
    TableName,
    ThemeName,
    check_output,
    file_name,
    theme_named,
)

SEED = 7  # of the board and the game in a demo


def demo(
    out: Annotated[
        Path | None,
        typer.Option(
            parser=file_name,
            metavar="FILE",
            help="File to write, .gif, .mp4 or .png. [default: demo.gif, or the next free name]",
        ),
    ] = None,
    seconds: Annotated[
        float,
        typer.Option(min=0.1, max=600.0, help="Length of the recording [s]; a PNG shows its last frame."),
    ] = 20.0,
    table: TableName = "silver_comet",
    seed: BoardSeed = SEED,
    player: PlayerName = "planner",
    size: Size = None,
    theme: ThemeName = "neon",
    music: Music = True,
    force: Force = False,
) -> None:
    """Film a game that the program plays by itself; an MP4 has sound. No display is needed.

    Example: `silverball demo --out demo.mp4 --seconds 20`
    """
    make_demo(
        out or free_name("demo.gif"),
        seconds,
        table,
        seed,
        size,
        player=player,
        theme=theme,
        music=music,
        force=force,
    )


def make_demo(
    out: Path,
    seconds: float = 20.0,
    table: str = "silver_comet",
    seed: int = SEED,
    size: int | None = None,
    *,
    player: str = "planner",
    theme: str = "neon",
    music: bool = True,
    force: bool = False,
) -> None:
    """Film a game, or draw its last frame, and print the name of the file.

    Args:
        out: File to write; its ending selects the format.
        seconds: Length of the recording [s].
        table: Built-in table or table file.
        seed: Seed of the board and the game.
        size: Height of the picture [pixel]; None: the default of the format.
        player: Name of the player.
        theme: Name of the theme.
        music: Whether an MP4 has music.
        force: Whether an existing file is overwritten.
    """
    from silverball.cli.filming import ENDINGS, film_size, record
    from silverball.drawing import Renderer
    from silverball.players import make_player
    from silverball.table import generate_table, load_table

    look = theme_named(theme)
    check_output(out, ENDINGS, force=force)
    chosen_player = make_player(player, seed)
    board = load_table(table)
    board_seed = None if board.random is None else seed
    if board.random is not None:
        board = generate_table(seed, board)
    picture_size = film_size(out, board, seconds, size)
    kernel, duration = (
        ("plan_worlds", "half a minute") if player == "planner" else ("step_single_world", "ten seconds")
    )
    with compiling(kernel, duration):
        from silverball.app.sessions import DemoSession
        from silverball.app.startup import warm_up

        warm_up(board)
        session = DemoSession(board, seed, chosen_player)
        chosen_player.press(session.game.world)
    with baking() as progress:
        renderer = Renderer(board, picture_size, theme=look, board_seed=board_seed, progress=progress)
    record(out, session, renderer, seconds, theme=theme, has_music=music)
    renderer.close()


def free_name(name: str) -> Path:
    """The first of demo.gif, demo-2.gif, demo-3.gif … that does not exist in this folder."""
    path = Path(name)
    number = 1
    while path.exists():
        number += 1
        path = Path(name).with_stem(f"{Path(name).stem}-{number}")
    return path
