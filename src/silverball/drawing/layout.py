"""A table as the drawing reads it: its board, and its primitives with the names of their parts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from silverball.table import Board, Table
from silverball.table.kinds.board import BORDERS
from silverball.table.primitive import Finish, Point, Primitive

OF_THE_MODE = "mode"  # the colour of a lamp that changes with the mode that runs
PLAIN_COLOR = "white"  # of such a lamp while no mode with a colour runs
STATES = ("off", "on", "blinking")
"""The states of a lamp by their numbers, those of `referee.game_records.Light`, which needs the compiler."""

RECIPE_FINISHES = (Finish.PRISM, Finish.BUMPER)
"""Finishes of what a recipe places at random: all of its boards are alike but for these."""


class Row(NamedTuple):
    """A primitive, and the part that it belongs to, by its name in events."""

    part: str
    primitive: Primitive


class Insert(NamedTuple):
    """A lamp with a place in the playfield.

    Attributes:
        lamp: Its number among the lamps of the table.
        center: Where its middle lies (x, z) [u].
        shape: The shape of its lens, as in the table file.
        size: Its radius [u].
        angle: To where it points [deg].
        color: The name of its colour; "auto": one of the theme; "mode": that of the moment.
        number: The number of its group, or of itself, among those that have colours of the theme.
        begins: Its state when a game begins, 0 off, 1 on, 2 blinking.
    """

    lamp: int
    center: Point
    shape: str
    size: float
    angle: float
    color: str
    number: int
    begins: int


class Light(NamedTuple):
    """A light of an insert: one in each colour that it can have.

    Attributes:
        insert: The number of the insert.
        color: The name of the colour, as that of an insert.
    """

    insert: int
    color: str


class Layout(NamedTuple):
    """What is drawn of a table.

    Attributes:
        name: The title of the table.
        board: Its board.
        rows: Its primitives, those of a part one after the other, without the borders, which are the
            first rows of a compiled board.
        inserts: Its lamps that lie in the playfield.
        mode_colors: The colours of its modes.
    """

    name: str
    board: Board
    rows: tuple[Row, ...]
    inserts: tuple[Insert, ...] = ()
    mode_colors: tuple[str, ...] = (PLAIN_COLOR,)

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
        colors = dict.fromkeys([PLAIN_COLOR, *(mode.color for mode in table.mode)])
        return cls(table.name, table.board, tuple(rows), tuple(_inserts(table)), tuple(colors))

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
    def lights(self) -> tuple[Light, ...]:
        """The lights of all inserts, those of an insert one after the other."""
        return tuple(
            Light(number, color)
            for number, insert in enumerate(self.inserts)
            for color in (self.mode_colors if insert.color == OF_THE_MODE else (insert.color,))
        )

    @property
    def levels(self) -> tuple[int, ...]:
        """The levels on which something is, the playfield (0) included, from low to high."""
        return tuple(sorted({0, *(level for row in self.rows for level in row.primitive.levels)}))


def _inserts(table: Table) -> Iterator[Insert]:
    """Yield the lamps of a table that have a place."""
    numbers: dict[str, int] = {}
    for index, lamp in enumerate(table.lamp):
        if lamp.center is not None:
            number = numbers.setdefault(lamp.group or f"{index}", len(numbers))
            yield Insert(
                index, lamp.center, lamp.shape, lamp.size, lamp.angle, lamp.color, number,
                STATES.index(lamp.begins),
            )  # fmt: skip
