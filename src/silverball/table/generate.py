"""Random boards: `generate_table` makes a board from a recipe and a seed."""

from __future__ import annotations

import functools
import os
from numbers import Integral

from silverball.errors import Problem, TableError
from silverball.table.check import check_layout
from silverball.table.file import load_table
from silverball.table.placed_parts import Layout
from silverball.table.placement import board_of
from silverball.table.quantity import shown
from silverball.table.table import Table


def generate_table(seed: int, recipe: str | os.PathLike[str] | Table = "random") -> Table:
    """Make a random board from a recipe and a seed.

    Args:
        seed: An integer ≥ 0; the same seed always makes the same board, on every machine.
        recipe: A table with a ``[random]`` section: a built-in name, a path or the table itself.

    Returns:
        A finished table, without a ``[random]`` section, named after the recipe and the seed.

    Raises:
        UnknownTable: No built-in table has the recipe's name.
        TableError: The seed is invalid, the table is not a recipe or has problems, or no layout meets its
            rules; the problem's path then names the rule, for example ``random.gap``.

    Examples:
        >>> import silverball as sb
        >>> board = sb.generate_table(7)
        >>> board.name, len(board.triangular_prism), len(board.cylinder)
        ('Random 7', 4, 3)
    """
    if isinstance(seed, bool) or not isinstance(seed, Integral) or int(seed) < 0:
        message = f"must be an integer ≥ 0, got {shown(seed)}"
        raise TableError("a random board", [Problem("seed", message)])
    table = recipe if isinstance(recipe, Table) else load_table(recipe)
    if table.random is None:
        message = "is missing: a table without a [random] section has nothing to place; load it instead"
        raise TableError(table.name, [Problem("random", message)])
    problems = _parts_problems(table)
    if problems:
        raise TableError(table.name, list(problems))
    return board_of(table, int(seed))


@functools.lru_cache(maxsize=16)
def _parts_problems(table: Table) -> tuple[Problem, ...]:
    """The errors of the parts and the rules of a recipe, checked once for all seeds."""
    return tuple(problem for problem in check_layout(Layout.of(table)) if problem.is_error)
