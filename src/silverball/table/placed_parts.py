"""The layout of a table: its parts with their paths in the file and the primitives that they are made of.

A file with mistakes has a layout too, made of its valid parts. Checks, reachability and the generator read a
layout; none of them knows the kinds of parts.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from silverball.table.geometry import Pieces, Polygon, closed_corners, is_solid, level_mask
from silverball.table.primitive import Primitive

if TYPE_CHECKING:
    from silverball.table.kinds import Board
    from silverball.table.kinds.part import Part
    from silverball.table.recipe import RandomRecipe
    from silverball.table.table import Table

# The keys that say where a part is; problems of its place are reported at the first one that it has.
PLACE_KEYS = ("end", "vertices", "center", "position", "pivot", "points")


class PlacedPart(NamedTuple):
    """One part of a layout.

    Attributes:
        path: Its place in the file, for example ``cylinder[2]``.
        model: What the file says.
        primitives: What it is made of.
    """

    path: str
    model: Part
    primitives: tuple[Primitive, ...]

    @property
    def place(self) -> str:
        """The path of the key that says where the part is."""
        keys = (key for key in PLACE_KEYS if isinstance(getattr(self.model, key, None), tuple))
        return ".".join([self.path, *list(keys)[:1]])

    @property
    def solid(self) -> tuple[Primitive, ...]:
        """The primitives that balls bounce off and that do not move."""
        return tuple(p for p in self.primitives if is_solid(p) and p.mover is None)


class Layout(NamedTuple):
    """The parts of a table, in the order of the file.

    Attributes:
        board: The board.
        parts: The parts that stand still or only switch.
        paddles: The parts that move.
        random: What to place at random, if anything.
        levels: The levels that the table has.
        has_narrow_lanes: Whether lanes that a ball barely fits are found: from format 2 on, because the
            places for new balls in tables of format 1 stay as they were.
    """

    board: Board
    parts: tuple[PlacedPart, ...] = ()
    paddles: tuple[PlacedPart, ...] = ()
    random: RandomRecipe | None = None
    levels: frozenset[int] = frozenset({0})
    has_narrow_lanes: bool = False

    @classmethod
    def of(cls, table: Table) -> Layout:
        """Return the layout of a whole table."""
        parts = [(path, part) for path, _, part in table.parts()]
        levels = [level.number for level in table.level]
        return cls.of_parts(table.board, parts, table.random, levels, table.format)

    @classmethod
    def of_parts(
        cls,
        board: Board,
        parts: Iterable[tuple[str, Part]],
        random: RandomRecipe | None = None,
        levels: Iterable[int] = (),
        table_format: int = 1,
    ) -> Layout:
        """Return the layout of some parts, each with its path in the file, and of the levels above 0."""
        placed = [PlacedPart(path, part, part.primitives(board)) for path, part in parts]
        moving = [part for part in placed if any(p.mover is not None for p in part.primitives)]
        still = [part for part in placed if all(p.mover is None for p in part.primitives)]
        moving.sort(key=lambda part: _number(part.path))  # in the order of the file, for messages
        return cls(board, tuple(still), tuple(moving), random, frozenset({0, *levels}), table_format > 1)

    def moving(self) -> list[tuple[str, Primitive]]:
        """Return the primitives of the paddles, with their paths."""
        return [(part.path, p) for part in self.paddles for p in part.primitives if p.mover is not None]

    def solids(self) -> Pieces:
        """Return the pieces of all parts that stand still; the index of a part is that in `parts`."""
        return Pieces.of(part.solid for part in self.parts)

    def polygons(self) -> list[Polygon]:
        """Return the insides of the parts that are closed chains."""
        found = []
        for index, part in enumerate(self.parts):
            corners = closed_corners(part.solid)
            if corners is not None:
                levels = level_mask(level for p in part.solid for level in p.levels)
                found.append(Polygon(corners, index, levels))
        return found


def _number(path: str) -> int:
    """The 12 of ``paddle[12]``."""
    return int(path.rpartition("[")[2].rstrip("]"))
