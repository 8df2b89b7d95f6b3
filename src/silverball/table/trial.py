"""Can this table be played? Its parts are checked, and of a recipe some boards are made.

The trial spends a tenth of the effort that a game may spend on a board (`placing.py`), so that luck decides
nothing: a recipe with one fit layout in a hundred passes here and is refused there with a chance of
4 in a million, and with every other share the chance is less.
"""

from __future__ import annotations

from silverball.errors import Problem, TableError
from silverball.table.check import Layout, check_layout
from silverball.table.parts import Table
from silverball.table.placement import BOARDS, LAYOUTS, board_of

SEEDS = 8  # that must each make a board
FEW_SEEDS = 2  # where a board costs up to a second
MANY_PARTS = 100  # from which it does


def check_table(table: Table) -> list[Problem]:
    """Every problem of a table, with its path; an empty list for a table that can be played."""
    return check_layout(Layout.of(table)) or try_recipe(table)


def try_recipe(table: Table) -> list[Problem]:
    """Which rule keeps a recipe, whose parts are good, from making boards; nothing of a finished table."""
    if table.random is None:
        return []
    parts = len(table.slant_wall) + len(table.triangular_prism) + len(table.cylinder)
    for seed in range(SEEDS if parts < MANY_PARTS else FEW_SEEDS):
        try:
            board_of(table, seed, layouts=LAYOUTS // 10, boards=BOARDS // 10)
        except TableError as error:
            return list(error.problems)
    return []
