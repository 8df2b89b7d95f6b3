"""A table as the drawing reads it: its board, and its primitives with the names of their parts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from silverball.physics.forms import Shape
from silverball.table import Board, Table
from silverball.table.primitive import Finish, Point, Primitive, arc_of

RECIPE_FINISHES = (Finish.PRISM, Finish.BUMPER)
"""Finishes of what a recipe places at random: all of its boards are alike but for these."""
ARC_STEP = math.radians(12.0)  # between two corners of a polygon that follows an arc


class Row(NamedTuple):
    """A primitive, and the part that it belongs to, by its name in events."""

    part: str
    primitive: Primitive


class Layout(NamedTuple):
    """What is drawn of a table.

    Attributes:
        name: The title of the table.
        board: Its board.
        rows: Its primitives, those of a part one after the other, without the borders.
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

    @property
    def levels(self) -> tuple[int, ...]:
        """The levels on which something is, the playfield (0) included, from low to high."""
        return tuple(sorted({0, *(level for row in self.rows for level in row.primitive.levels)}))


def closed_outline(primitives: tuple[Primitive, ...]) -> tuple[Point, ...] | None:
    """Return the corners of the area that the primitives of a part enclose; None if they are no closed chain.

    Arcs are followed by corners at small angles.
    """
    if len(primitives) < 2 or any(p.shape not in (Shape.CAPSULE, Shape.ARC) for p in primitives):
        return None
    for first, second in zip(primitives, (*primitives[1:], primitives[0]), strict=True):
        if math.dist(first.points[1], second.points[0]) > 1e-6:
            return None
    corners = tuple(corner for primitive in primitives for corner in path(primitive)[:-1])
    return corners if len(corners) > 2 else None


def path(primitive: Primitive) -> list[Point]:
    """Return points along a CAPSULE, LINE or ARC, from start to end."""
    start, end = primitive.points
    if primitive.shape != Shape.ARC:
        return [start, end]
    center, radius, _, half_angle, _ = arc_of(start, end, primitive.bulge)
    count = max(math.ceil(2.0 * half_angle / ARC_STEP), 2)
    first = math.atan2(start[0] - center[0], start[1] - center[1])
    turn = math.copysign(2.0 * half_angle / count, primitive.bulge)
    between = (first + step * turn for step in range(1, count))
    inner = [
        (center[0] + radius * math.sin(angle), center[1] + radius * math.cos(angle)) for angle in between
    ]
    return [start, *inner, end]
