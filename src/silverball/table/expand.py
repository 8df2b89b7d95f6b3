"""Expansion of a table: all its parts as primitives, numbered as a compiled board numbers them.

    part (what a person writes)  →  primitives: shape × response × finish  →  rows of the compiled board

A part has one number, the column of its tally and the number in events; each of its primitives is one row.
The first parts are the three borders, then come the paddles, then all others (`Table.parts`).
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from silverball.table.kinds import Board
from silverball.table.kinds.board import BORDERS, LEVELS
from silverball.table.kinds.part import Part
from silverball.table.primitive import Point, Primitive
from silverball.table.table import Table


class Row(NamedTuple):
    """One primitive, and the number of the part to which it belongs."""

    part: int
    primitive: Primitive


class ExpandedPart(NamedTuple):
    """One part with its primitives.

    Attributes:
        name: Its name in events: ``board.left``, ``paddle.left``, ``cylinder[2]``.
        path: Its place in the file: ``board``, ``paddle[0]``, ``cylinder[2]``.
        part: The part itself; of the borders the board.
        first: The number of its first row.
        primitives: What it is made of, in the order of the rows.
    """

    name: str
    path: str
    part: Part | Board
    first: int
    primitives: tuple[Primitive, ...]

    @property
    def kind(self) -> str:
        """The section of the file that describes it: ``board``, ``paddle``, ``cylinder``."""
        return self.path.partition("[")[0]

    @property
    def points(self) -> int:
        """The points for a hit."""
        return 0 if isinstance(self.part, Board) else self.part.worth


class Expansion(NamedTuple):
    """A table as parts and rows.

    Attributes:
        parts: The parts in the order of their numbers.
        rows: All primitives in the order of the rows of the compiled board.
        numbers: The number of each part by its name in events.
        named: The number of each part by the name that the maker of the table gave it, if any.
        gravity: The acceleration of a sliding ball on each level, (gx, gz) [u/s²].
    """

    parts: tuple[ExpandedPart, ...]
    rows: tuple[Row, ...]
    numbers: dict[str, int]
    named: dict[str, int]
    gravity: tuple[Point, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The name of each part in events, in the order of the numbers."""
        return tuple(part.name for part in self.parts)


@lru_cache(maxsize=64)
def expand(table: Table) -> Expansion:
    """Expand a finished table; a recipe expands into the parts that it has without its random ones.

    Raises:
        TableError: A mesh cannot be read or used.

    Examples:
        >>> import silverball as sb
        >>> from silverball.table import expand
        >>> classic = expand(sb.load_table("classic"))
        >>> classic.names[:5]
        ('board.left', 'board.right', 'board.top', 'paddle.left', 'paddle.right')
        >>> classic.rows[3].primitive.shape.name
        'TRIANGLE'
    """
    from silverball.physics.portable_math import (
        sine_cosine,  # needs the compiler, which reading a table does not
    )

    table = table.resolved()
    parts: list[ExpandedPart] = []
    for border, primitive in zip(BORDERS, table.board.primitives(), strict=True):
        parts.append(ExpandedPart(f"board.{border}", "board", table.board, len(parts), (primitive,)))
    first = len(parts)
    for path, name, part in table.parts():
        primitives = part.primitives(table.board, sine_cosine)
        # A drop target without a bank is a bank of its own.
        primitives = tuple(p._replace(bank=p.bank or name) if p.bank is not None else p for p in primitives)
        parts.append(ExpandedPart(name, path, part, first, primitives))
        first += len(primitives)
    gravity: list[Point] = [(0.0 - table.board.gravity, 0.0)] * LEVELS
    for level in table.level:
        if level.gravity is not None:
            gravity[level.number] = level.gravity
    return Expansion(
        parts=tuple(parts),
        rows=tuple(Row(number, one) for number, part in enumerate(parts) for one in part.primitives),
        numbers={part.name: number for number, part in enumerate(parts)},
        named={
            part.part.name: number
            for number, part in enumerate(parts)
            if isinstance(part.part, Part) and part.part.name
        },
        gravity=tuple(gravity),
    )
