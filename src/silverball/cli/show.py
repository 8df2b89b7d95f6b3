"""`silverball show`: a picture of a table."""

from __future__ import annotations

from pathlib import Path

import typer

from silverball.cli.output import file_name
from silverball.cli.say import say


def show(
    out: Path = typer.Option(..., parser=file_name, metavar="FILE.png", help="Where to write the picture."),
    table: str = typer.Option("classic", help="A built-in table or a table file."),
    seed: int = typer.Option(0, min=0, max=2**63 - 1, help="Of the board, if the table makes random ones."),
    size: int = typer.Option(1152, min=100, max=8640, help="Height of the picture in pixels."),
    theme: str = typer.Option("neon", help="The look: neon, parlour or clear (for colour-blind eyes)."),
    force: bool = typer.Option(False, "--force", help="Overwrite a file that exists."),
) -> None:
    """Draw a table into a picture.

    Example: `silverball show --table random --seed 7 --theme parlour --out seven.png`
    """
    from silverball.cli.look import baking, theme_named
    from silverball.drawing import Moment, Renderer, best_size
    from silverball.export.film import check_output, write_picture
    from silverball.table import generate_table, load_table

    look = theme_named(theme)
    check_output(out, (".png",), force=force)
    board = load_table(table)
    board_seed = None if board.random is None else seed
    if board.random is not None:
        board = generate_table(seed, board)
    with baking() as progress:
        renderer = Renderer(
            board, best_size(board.board, size), theme=look, board_seed=board_seed, progress=progress
        )
        picture = renderer.array(Moment.before(board))
    renderer.close()
    write_picture(out, picture)
    say(f"wrote {out}")
