"""Which tables can every engine play alike?

General engines have one restitution for each shape, and pairs are combined by their own rules: pymunk
multiplies, Box2D takes the larger. Boosts, slow-downs and restitutions that fall with the speed would need a
call back into Python at every contact, which would slow the peers down and not Silverball. So the tables here
leave them out, for all engines: `plain` is any table without them.
"""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import BaseModel

from silverball.table import Table, generate_table
from silverball.table.parts import SlantWall

FLOOR = -8.0  # [u] x of the floor of a closed table
CEILING_SPEED = 200.0  # [u/s] a cap that nothing reaches
LEAST_HIT_SPEED = 0.01  # [u/s] so that next to no contact of the elastic table is a touch, which may hop

Model = TypeVar("Model", bound=BaseModel)


def board(table: Table, seed: int) -> Table:
    """The plain form of a table, or of the board that a recipe makes of a seed."""
    return plain(table if table.random is None else generate_table(seed, table))


def plain(table: Table) -> Table:
    """The table without boost, slow-down and falloff; balls bounce off each other as the dullest part does.

    With that restitution of the balls, the larger of a ball's and a part's (Box2D's rule) is the part's.
    """
    flat = _with_all_parts(table, speed_factor=1.0, restitution_falloff=0.0)
    return flat.model_copy(
        update={"board": flat.board.model_copy(update={"ball_restitution": least_restitution(flat)})}
    )


def least_restitution(table: Table) -> float:
    """The smallest restitution of any part of a table."""
    surfaces: list[Any] = [*table.slant_wall, *table.paddle, *table.triangular_prism, *table.cylinder]
    return min([table.board.wall_restitution, *(float(part.restitution) for part in surfaces)])


def elastic(table: Table) -> Table:
    """The table with every restitution 1, without paddles and closed at the bottom: no energy leaves it."""
    half = table.board.width / 2
    floor = SlantWall(start=(FLOOR, -half), end=(FLOOR, half))
    closed = plain(table).model_copy(update={"paddle": (), "slant_wall": (*table.slant_wall, floor)})
    return _with_all_parts(closed, restitution=1.0).model_copy(
        update={
            "board": closed.board.model_copy(
                update={
                    "wall_restitution": 1.0,
                    "ball_restitution": 1.0,
                    "hit_speed": LEAST_HIT_SPEED,
                    "speed_cap": CEILING_SPEED,
                }
            )
        }
    )


def _with_all_parts(table: Table, **values: float) -> Table:
    """The table with these values in every part that has such a field."""

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
