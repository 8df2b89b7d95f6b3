"""`silverball show`: draws a table into a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from silverball.cli.console import baking, print_lines
from silverball.cli.shared_options import (
    BoardSeed,
    Force,
    TableName,
    ThemeName,
    check_output,
    file_name,
    theme_named,
)


def show(
    out: Annotated[Path, typer.Option(parser=file_name, metavar="FILE.png", help="Picture to write.")],
    table: TableName = "classic",
    seed: BoardSeed = 0,
    size: Annotated[int, typer.Option(min=100, max=8640, help="Height of the picture [pixels].")] = 1152,
    theme: ThemeName = "neon",
    force: Force = False,
) -> None:
    """Draw a table into a PNG.

    Example: `silverball show --table random --seed 7 --theme parlour --out seven.png`
    """
    from silverball.drawing import Moment, Renderer, best_size
    from silverball.export.film import write_picture
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
    print_lines(f"wrote {out}")
