"""`silverball demo`: the program plays by itself, into a file."""

from __future__ import annotations

from pathlib import Path

import typer

from silverball.cli.output import file_name


def demo(
    out: Path | None = typer.Option(
        None,
        parser=file_name,
        metavar="FILE",
        help="Ends in .gif, .mp4 or .png; demo.gif in this folder if not given.",
    ),
    seconds: float = typer.Option(20.0, min=0.1, max=600.0, help="Of play. A PNG shows the last moment."),
    table: str = typer.Option("classic", help="A built-in table or a table file."),
    seed: int = typer.Option(7, min=0, max=2**63 - 1, help="Of the board and of everything random on it."),
    player: str = typer.Option("planner", help="Who plays: idle, random, reflex, hold, planner or trained."),
    size: int | None = typer.Option(None, min=100, max=4320, help="Height of the picture in pixels."),
    theme: str = typer.Option("neon", help="The look: neon, parlour or clear (for colour-blind eyes)."),
    force: bool = typer.Option(False, "--force", help="Overwrite a file that exists."),
) -> None:
    """Let the program play by itself and make a film of it, with sound in an MP4; no display is needed.

    Example: `silverball demo --out demo.mp4 --seconds 20`
    """
    place = out or free_name("demo.gif")
    make_demo(place, seconds, table, seed, size, player=player, theme=theme, force=force)


def make_demo(
    out: Path,
    seconds: float = 20.0,
    table: str = "classic",
    seed: int = 7,
    size: int | None = None,
    *,
    player: str = "planner",
    theme: str = "neon",
    force: bool = False,
) -> None:
    """Make a film, or a picture, of the program playing; say where it is."""
    from silverball.cli.console import compiling
    from silverball.cli.look import baking, theme_named
    from silverball.cli.recording import ENDINGS, film_size, record
    from silverball.drawing import Renderer
    from silverball.export.film import check_output
    from silverball.players import make_player
    from silverball.table import generate_table, load_table

    look = theme_named(theme)
    check_output(out, ENDINGS, force=force)
    hands = make_player(player)
    board = load_table(table)
    board_seed = None if board.random is None else seed
    if board.random is not None:
        board = generate_table(seed, board)
    picture_size = film_size(out, board, seconds, size)
    kernel, about = ("plan_worlds", "half a minute") if player == "planner" else ("run_worlds", "ten seconds")
    with compiling(kernel, about):
        from silverball.app.sessions import DemoSession
        from silverball.app.startup import warm_up

        warm_up(board)
        stage = DemoSession(board, seed, hands)
        hands.press(stage.game.world)
    with baking() as progress:
        renderer = Renderer(board, picture_size, theme=look, board_seed=board_seed, progress=progress)
    record(out, stage, renderer, seconds)
    renderer.close()


def free_name(name: str) -> Path:
    """A name in this folder that no file has: demo.gif, or else demo-2.gif, demo-3.gif and so on."""
    path = Path(name)
    number = 1
    while path.exists():
        number += 1
        path = Path(name).with_stem(f"{Path(name).stem}-{number}")
    return path
