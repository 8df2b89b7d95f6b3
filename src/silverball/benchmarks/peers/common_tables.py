"""Tables that every engine can play in the same way.

General engines have one restitution per shape and combine two of them by their own rule: pymunk multiplies
them, Box2D takes the larger. Boosts, slow-downs and restitutions that fall with the speed would need a
callback into Python at every contact, which would slow down the peers but not Silverball. `plain` removes
them from a table, for all engines.
"""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import BaseModel

from silverball.table import Table, generate_table
from silverball.table.parts import SlantWall

FLOOR = -8.0  # [u] x of the floor of a closed table
UNREACHED_SPEED = 200.0  # [u/s] a speed cap that no ball reaches
MIN_HIT_SPEED = 0.01  # [u/s] so low that almost every contact of the elastic table is a hit

Model = TypeVar("Model", bound=BaseModel)


def board(table: Table, seed: int) -> Table:
    """The plain form of a table, or of the board that a recipe gives for a seed."""
    return plain(table if table.random is None else generate_table(seed, table))


def plain(table: Table) -> Table:
    """The table without boost, slow-down and falloff; balls get the smallest restitution of any part.

    The larger restitution of a ball and a part (the rule of Box2D) is then that of the part.
    """
    flat = _with_values(table, speed_factor=1.0, restitution_falloff=0.0)
    return flat.model_copy(
        update={"board": flat.board.model_copy(update={"ball_restitution": min_restitution(flat)})}
    )


def min_restitution(table: Table) -> float:
    """The smallest restitution of any part or border of a table."""
    surfaces: list[Any] = [*table.slant_wall, *table.paddle, *table.triangular_prism, *table.cylinder]
    return min([table.board.wall_restitution, *(float(part.restitution) for part in surfaces)])


def elastic(table: Table) -> Table:
    """The table without paddles, closed at the bottom, with every restitution 1: it conserves energy."""
    half = table.board.width / 2
    floor = SlantWall(start=(FLOOR, -half), end=(FLOOR, half))
    closed = plain(table).model_copy(update={"paddle": (), "slant_wall": (*table.slant_wall, floor)})
    return _with_values(closed, restitution=1.0).model_copy(
        update={
            "board": closed.board.model_copy(
                update={
                    "wall_restitution": 1.0,
                    "ball_restitution": 1.0,
                    "hit_speed": MIN_HIT_SPEED,
                    "speed_cap": UNREACHED_SPEED,
                }
            )
        }
    )


def _with_values(table: Table, **values: float) -> Table:
    """The table with these values in every part that has the fields."""

    def changed(part: Model) -> Model:
        known: dict[str, Any] = {
            name: value for name, value in values.items() if name in type(part).model_fields
        }
        return part.model_copy(update=known)

    return table.model_copy(
        update={
            "slant_wall": tuple(changed(part) for part in table.slant_wall),
            "paddle": tuple(changed(part) for part in table.paddle),
            "triangular_prism": tuple(changed(part) for part in table.triangular_prism),
            "cylinder": tuple(changed(part) for part in table.cylinder),
        }
    )
