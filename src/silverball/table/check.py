"""Can this table be played? (the checks follow)"""

from __future__ import annotations

from typing import NamedTuple

from silverball.errors import Problem
from silverball.table.parts import Board, Cylinder, Paddle, RandomRecipe, SlantWall, Table, TriangularPrism


class Layout(NamedTuple):
    """The parts of a table, each with its path in the file.

    A table has one for all its parts; of a file with mistakes, the parts without any make one too.
    """

    board: Board
    slant_walls: tuple[tuple[str, SlantWall], ...]
    paddles: tuple[tuple[str, Paddle], ...]
    triangular_prisms: tuple[tuple[str, TriangularPrism], ...]
    cylinders: tuple[tuple[str, Cylinder], ...]
    random: RandomRecipe | None

    @classmethod
    def of(cls, table: Table) -> Layout:
        """The layout of a whole table."""
        return cls(
            table.board,
            tuple((f"slant_wall[{i}]", part) for i, part in enumerate(table.slant_wall)),
            tuple((f"paddle[{i}]", part) for i, part in enumerate(table.paddle)),
            tuple((f"triangular_prism[{i}]", part) for i, part in enumerate(table.triangular_prism)),
            tuple((f"cylinder[{i}]", part) for i, part in enumerate(table.cylinder)),
            table.random,
        )


def check_table(table: Table) -> list[Problem]:
    """Every problem of a table, with its path; an empty list for a good one."""
    return check_layout(Layout.of(table))


def check_layout(layout: Layout) -> list[Problem]:
    """The same for a layout."""
    return []
