"""What the parts of a table do in a game: their points, the buttons that work, and the plungers.

Everything is read from the primitives of the parts, whatever their kinds, and without the compiler: the
window shows it before the physics is loaded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from silverball.table.kinds.board import BORDERS

if TYPE_CHECKING:
    from silverball.table import Table
    from silverball.table.primitive import Primitive

SCORING = frozenset({"hit", "pass", "spin", "captured"})
"""The events of a world that give the points of their part."""


def primitives_by_part(table: Table) -> dict[str, tuple[Primitive, ...]]:
    """The primitives of every part of a table, by its name in events, in the order of their numbers."""
    table = table.resolved()
    borders = zip(BORDERS, table.board.primitives(), strict=True)
    found = {f"board.{border}": (primitive,) for border, primitive in borders}
    return found | {one.name: one.part.primitives(table.board) for one in table.parts()}


def points_by_part(table: Table) -> dict[str, int]:
    """The points of every part that can give any, by its name in events."""
    return {one.name: one.part.worth for one in table.parts()}


def paddle_buttons(table: Table) -> frozenset[str]:
    """The buttons that move a paddle, "left" and "right"."""
    movers = (one.mover for primitives in primitives_by_part(table).values() for one in primitives)
    return frozenset(mover.button for mover in movers if mover is not None)


def held_gates(table: Table) -> dict[str, str]:
    """The gates that rules open: the name in events by the name that the table gives them."""
    primitives = primitives_by_part(table)
    return {
        one.part.name: one.name
        for one in table.parts()
        if any(primitive.is_gate for primitive in primitives[one.name])
    }


def plungers(table: Table) -> frozenset[str]:
    """The names of the parts that launch balls; empty: balls start on the board by themselves."""
    return frozenset(
        name
        for name, primitives in primitives_by_part(table).items()
        if any(one.launch is not None for one in primitives)
    )
