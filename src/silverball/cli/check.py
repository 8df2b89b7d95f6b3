"""`silverball check FILE`: reports every problem of a table."""

from __future__ import annotations

from typing import Annotated

import typer

from silverball.cli.completion import complete_table
from silverball.cli.console import print_json, print_lines
from silverball.cli.shared_options import AsJson


def check(
    table: Annotated[
        str,
        typer.Argument(
            metavar="FILE",
            help="Table file, or name of a built-in table.",
            autocompletion=complete_table,
        ),
    ],
    strict: Annotated[bool, typer.Option("--strict", help="Treat warnings as errors.")] = False,
    as_json: AsJson = False,
) -> None:
    """Check a table and report all of its problems.

    Errors keep a table from being played: unknown keys, values out of range, paddles that touch something
    while they turn, boards that a ball cannot leave. Warnings are what its maker may want: parts that
    overlap, gaps that a ball barely fits, places where a ball could lie forever.

    Exit codes: 0 no errors, 2 errors; with `--strict` 2 for warnings too.

    Example: `silverball check mine.toml --strict`
    """
    from silverball.errors import TableError
    from silverball.table.file import examine_table

    loaded, problems = examine_table(table)
    errors = [problem for problem in problems if strict or problem.is_error]
    warnings = [problem for problem in problems if problem not in errors]
    if as_json:
        print_json(
            {
                "table": table,
                "errors": sum(problem.is_error for problem in problems),
                "warnings": sum(not problem.is_error for problem in problems),
                "problems": [problem._asdict() for problem in problems],
            }
        )
        raise typer.Exit(2 if errors else 0)
    if warnings:
        count = f"{len(warnings)} warning{'' if len(warnings) == 1 else 's'}"
        print_lines(f"{table}: {count}", *(f"  warning: {problem}" for problem in warnings))
    if errors:
        raise TableError(table, errors)
    if loaded is not None and not warnings:
        print_lines(f"{table}: no problems in {loaded.name!r}")
