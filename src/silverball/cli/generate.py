"""`silverball generate`: writes a random board as a table file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from silverball.cli.completion import complete_table
from silverball.cli.console import print_lines
from silverball.cli.shared_options import LAST_SEED, Force, check_output


def generate(
    seed: Annotated[
        int, typer.Option(min=0, max=LAST_SEED, help="Seed; the same seed always gives the same board.")
    ] = 0,
    out: Annotated[
        Path | None, typer.Option(metavar="FILE.toml", help="File to write. [default: standard output]")
    ] = None,
    recipe: Annotated[
        str,
        typer.Option(
            "--table", help="Recipe: a table with a \\[random] section.", autocompletion=complete_table
        ),
    ] = "random",
    force: Force = False,
) -> None:
    """Generate a random board: the recipe's obstacles, placed at random.

    Example: `silverball generate --seed 7 --out seven.toml`
    """
    from silverball.table import dump_table, generate_table, save_table

    board = generate_table(seed, recipe)
    if out is None:
        print_lines(*dump_table(board).removesuffix("\n").split("\n"))
        return
    check_output(out, (".toml",), force=force)
    save_table(board, out)
    print_lines(f"wrote {out}")
