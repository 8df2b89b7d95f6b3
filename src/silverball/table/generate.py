"""Which board does a seed make of a recipe? How it is made stands in `placing.py`."""

from __future__ import annotations

import functools
import os
from numbers import Integral

from silverball.errors import Problem, TableError
from silverball.table.check import Layout, check_layout
from silverball.table.file import load_table
from silverball.table.placement import board_of
from silverball.table.quantity import shown
from silverball.table.table import Table


def generate_table(seed: int, recipe: str | os.PathLike[str] | Table = "random") -> Table:
    """The board that a seed makes of a recipe.

    Args:
        seed: Any whole number from 0; the same seed always makes the same board.
        recipe: A table with a ``[random]`` section: a built-in name, a path or the table itself.

    Returns:
        A finished table, without a ``[random]`` section, named after the recipe and the seed.

    Raises:
        UnknownTable: No built-in table has the recipe's name.
        TableError: The table is no recipe or has problems, or no layout keeps its rules; the problem's
            path then names the rule, for example ``random.gap``.
    """
    if isinstance(seed, bool) or not isinstance(seed, Integral) or int(seed) < 0:
        message = f"must be a whole number from 0, got {shown(seed)}"
        raise TableError("a random board", [Problem("seed", message)])
    table = recipe if isinstance(recipe, Table) else load_table(recipe)
    if table.random is None:
        message = "must be there: without a [random] section there is nothing to place, just load the table"
        raise TableError(table.name, [Problem("random", message)])
    problems = _parts_problems(table)
    if problems:
        raise TableError(table.name, list(problems))
    return board_of(table, int(seed))


@functools.lru_cache(maxsize=16)
def _parts_problems(table: Table) -> tuple[Problem, ...]:
    """What is wrong with the standing parts and the rules of a recipe, looked at once for all seeds."""
    return tuple(check_layout(Layout.of(table)))
