"""A table as the drawing reads it: its board, and its primitives with the names of their parts."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from silverball.table import Board, Table
from silverball.table.kinds.board import BORDERS
from silverball.table.primitive import Finish, Primitive

RECIPE_FINISHES = (Finish.PRISM, Finish.BUMPER)
"""Finishes of what a recipe places at random: all of its boards are alike but for these."""


class Row(NamedTuple):
    """A primitive, and the part that it belongs to, by its name in events."""

    part: str
    primitive: Primitive


class Layout(NamedTuple):
    """What is drawn of a table.

    Attributes:
        name: The title of the table.
        board: Its board.
        rows: Its primitives, those of a part one after the other, without the borders, which are the
            first rows of a compiled board.
    """

    name: str
    board: Board
    rows: tuple[Row, ...]

    @classmethod
    def of(cls, table: Table) -> Layout:
        """Return the layout of a finished table."""
        # Not `expand`, which needs the compiler; the last bit of a prism's corners cannot be seen.
        table = table.resolved()
        rows = (
            Row(name, primitive)
            for _, name, part in table.parts()
            for primitive in part.primitives(table.board)
        )
        return cls(table.name, table.board, tuple(rows))

    def without(self, is_left_out: Callable[[Primitive], bool]) -> Layout:
        """Return the layout without some of its primitives."""
        return self._replace(rows=tuple(row for row in self.rows if not is_left_out(row.primitive)))

    def without_obstacles(self) -> Layout:
        """Return what all boards of a recipe share."""
        return self.without(lambda primitive: primitive.finish in RECIPE_FINISHES)

    def is_hole(self, row: int) -> bool:
        """Return whether a row of the compiled board is a hole."""
        row -= len(BORDERS)
        return 0 <= row < len(self.rows) and self.rows[row].primitive.hold is not None

    @property
    def levels(self) -> tuple[int, ...]:
        """The levels on which something is, the playfield (0) included, from low to high."""
        return tuple(sorted({0, *(level for row in self.rows for level in row.primitive.levels)}))
