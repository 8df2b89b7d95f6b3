"""The board: its borders, and the physics of every ball on it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, ValidationInfo, field_validator

from silverball.physics.forms import Shape
from silverball.table.model import SINCE_2, Friction, HitSpeed, Model, Restitution, Thickness
from silverball.table.primitive import Finish, Point, Primitive, Surface
from silverball.table.quantity import COORDINATE, Count, Quantity, refuse

LEVELS = 8
"""The number of levels that a table may have, 0 to 7."""

MAX_BALLS = 8
"""The greatest number of balls on a board."""

BORDERS = ("left", "right", "top")
"""The borders in the order of their primitives."""


class Board(Model):
    """The board, its borders (left, right, top), and the physics of every ball on it."""

    length: Annotated[float, Quantity(4.0, 50.0, "u")] = 20.0
    """[u] along x: the board spans x = −length/2 … length/2."""
    width: Annotated[float, Quantity(2.0, 50.0, "u")] = 10.0
    """[u] along z: the board spans z = −width/2 … width/2."""
    height: Annotated[float, Quantity(0.0, 10.0, "u")] = 1.0
    """[u] height y of the plane in which the balls move."""
    gravity: Annotated[float, Quantity(0.0, 100.0, "u/s²")] = 10.0
    """[u/s²] acceleration of a sliding ball along the board, towards −x; at 0 a ball may never drain."""
    slope: Annotated[float, Quantity(1.0, 60.0, "deg")] = 6.5
    """[deg] slope of the board; it sets the acceleration onto it, gravity / tan(slope), which rolling
    needs."""
    friction: Friction = 0.0
    """Coefficient of friction wherever a ball touches something; 0.2 is steel on lacquer."""
    rolling: Annotated[bool, Field(strict=True)] = False
    """Whether the playfield has friction too, so that balls slip and roll on it; needs friction above 0.
    Without it, or without gravity, balls slide."""
    ball_radius: Annotated[float, Quantity(0.1, 2.0, "u")] = 0.25
    """[u] radius of every ball."""
    ball_restitution: Restitution = 0.95
    """Restitution of ball against ball."""
    max_balls: Annotated[int, Count(1, MAX_BALLS, "balls", before=(1, 2))] = 2
    """Balls that may be on the board at once, 1 to 8; more than 2 need format 2."""
    speed_cap: Annotated[float, Quantity(1.0, 200.0, "u/s")] = 22.0
    """[u/s] no ball is faster; a paddle's tip must stay slower."""
    hit_speed: HitSpeed = 0.5
    """[u/s] an impact above it is a hit, below it a touch."""
    jitter: Annotated[float, Quantity(0.0, 20.0, "u/s")] = 1.5
    """[u/s] speed that a shove by the player adds to a ball."""
    nudge: Annotated[float, Quantity(0.0, 20.0, "u/s"), SINCE_2] = 0.0
    """[u/s] speed that a nudge gives the cabinet, which swings back; all balls feel it, and a shove is then a
    nudge. 5.5 moves the cabinet by 0.1 u. 0: there is no nudge, and a shove is the jitter."""
    gutter: Annotated[float, COORDINATE] = -9.0
    """[u] x of the gutter; a ball whose centre crosses it leaves the board."""
    wall_thickness: Thickness = 0.1
    """[u] thickness of the borders, inwards from the edge of the board."""
    wall_restitution: Restitution = 0.8
    """Restitution of the borders."""

    @field_validator("rolling")
    @classmethod
    def _has_friction(cls, rolling: bool, info: ValidationInfo) -> bool:
        if rolling and info.data.get("friction") == 0.0:
            refuse("needs friction above 0: a ball without friction slides; give friction = 0.2, for example")
        return rolling

    @property
    def center(self) -> Point:
        """The centre of the board (x, z) [u]: the origin, by definition."""
        return (0.0, 0.0)

    def primitives(self) -> tuple[Primitive, ...]:
        """Return the borders, in the order of `BORDERS`; they are on all levels."""
        across, top = 0.5 * self.width - self.wall_thickness, 0.5 * self.length - self.wall_thickness
        planes: tuple[tuple[Point, Point], ...] = (
            ((0.0, -across), (0.0, 1.0)),
            ((0.0, across), (0.0, -1.0)),
            ((top, 0.0), (-1.0, 0.0)),
        )
        surface = Surface(restitution=self.wall_restitution)
        return tuple(
            Primitive(Shape.PLANE, plane, surface=surface, finish=Finish.BORDER, levels=tuple(range(LEVELS)))
            for plane in planes
        )
