"""`silverball generate`: a random board as a table file."""

from __future__ import annotations

from pathlib import Path

import typer

from silverball.cli.say import say


def generate(
    seed: int = typer.Option(0, min=0, max=2**63 - 1, help="The same seed always gives the same board."),
    out: Path | None = typer.Option(
        None, metavar="FILE.toml", help="Where to write it; without, it is printed."
    ),
    recipe: str = typer.Option("random", "--table", help="The recipe: a table with a \\[random] section."),
    force: bool = typer.Option(False, "--force", help="Overwrite a file that exists."),
) -> None:
    """Make a random board: obstacles placed anew for every seed.

    Example: `silverball generate --seed 7 --out seven.toml`
    """
    from silverball.errors import OutputError
    from silverball.table import dump_table, generate_table, save_table

    board = generate_table(seed, recipe)
    if out is None:
        say(*dump_table(board).removesuffix("\n").split("\n"))
        return
    if out.exists() and not force:
        raise OutputError(f"{out}: this file exists; choose another name, or overwrite it with --force")
    save_table(board, out)
    say(f"wrote {out}")
