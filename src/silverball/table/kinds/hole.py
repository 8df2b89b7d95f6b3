"""Holes: saucers, scoops, subways and drains, which catch a ball and may send it off elsewhere."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import Field, model_validator

from silverball.physics.forms import Response, Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import LevelNumber, Scored
from silverball.table.model import Place, Points, SineCosine, libm
from silverball.table.primitive import Finish, Hold, Point, Primitive, Surface
from silverball.table.quantity import FixedList, Quantity, refuse

_SPEED = FixedList(Quantity(-100.0, 100.0, "u/s"), 2, "[vx, vz]")


class Hole(Scored):
    """A hole that catches a slow ball, holds it for a while and sends it off, or loses it as a drain."""

    center: Place
    """[u] the centre, [x, z]."""
    radius: Annotated[float, Quantity(0.05, 5.0, "u")] = 0.3
    """[u] a ball is caught when its centre comes this near."""
    capture_speed: Annotated[float, Quantity(0.1, 200.0, "u/s")] = 17.0
    """[u/s] a faster ball crosses it."""
    hold: Annotated[float, Quantity(0.0, 60.0, "s")] = 1.0
    """[s] how long it holds a ball."""
    exit: Place | None = None
    """[u] where the ball comes out, [x, z]; by default at the centre."""
    exit_velocity: Annotated[Point, _SPEED] | None = None
    """[u/s] velocity of the ball that comes out, [vx, vz]; needed unless it is a drain."""
    spread: Annotated[float, Quantity(0.0, 90.0, "deg")] = 2.0
    """[deg] by which the direction of the ball that comes out varies at most, at random."""
    exit_level: LevelNumber | None = None
    """The level on which the ball comes out; by default that of the hole."""
    drain: Annotated[bool, Field(strict=True)] = False
    """Whether the ball is lost, as in the gutter."""
    points: Points = 500
    """Points for a ball that is caught; a drain gives none."""

    @model_validator(mode="after")
    def _has_one_way_out(self) -> Self:
        given = [key for key in ("exit", "exit_velocity", "exit_level") if getattr(self, key) is not None]
        if self.drain and given:
            refuse(f"must not have `{given[0]}`: it is a drain")
        if not self.drain and self.exit_velocity is None:
            refuse("needs `exit_velocity`, for example [-10, 0], or `drain = true`")
        return self

    @property
    def worth(self) -> int:
        """The points for a ball that is caught."""
        return 0 if self.drain else self.points

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one disc that holds a ball."""
        del board, sine_cosine
        return (
            Primitive(
                Shape.DISC,
                (self.center,),
                self.radius,
                response=Response.HOLD,
                surface=Surface(points=self.worth),
                finish=Finish.HOLE,
                levels=self.all_levels,
                hold=Hold(
                    capture_speed=self.capture_speed,
                    duration=self.hold,
                    exit=self.center if self.exit is None else self.exit,
                    exit_velocity=self.exit_velocity or (0.0, 0.0),
                    spread=math.radians(self.spread),
                    exit_level=self.all_levels[0] if self.exit_level is None else self.exit_level,
                    is_drain=self.drain,
                ),
            ),
        )
