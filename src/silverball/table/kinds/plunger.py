"""Plungers, from which balls are launched."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import model_validator

from silverball.physics.forms import Response, Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Part
from silverball.table.model import SINCE_2, Place, SineCosine, libm
from silverball.table.primitive import Finish, Launch, Primitive
from silverball.table.quantity import Interval, Quantity, refuse


class Plunger(Part):
    """A plunger: new balls lie on it, and the launch button sends them off, faster the longer it is held."""

    position: Place
    """[u] the centre of a ball that lies on it, [x, z]."""
    launch: Annotated[tuple[float, float], Interval(Quantity(0.5, 200.0, "u/s"))] = (8.0, 20.0)
    """[u/s] speed of a launched ball, [least, greatest]."""
    charge: Annotated[float, Quantity(0.05, 10.0, "s")] = 1.0
    """[s] how long the button is held for the greatest speed."""
    angle: Annotated[float, Quantity(-180.0, 180.0, "deg")] = 90.0
    """[deg] direction in which it launches; 90 is up the table."""
    auto_launch: Annotated[
        Annotated[tuple[float, float], Interval(Quantity(0.5, 200.0, "u/s"))] | None, SINCE_2
    ] = None
    """[u/s] speed, [least, greatest], at which a game itself launches the balls that it brings: those of a
    multiball, a saved ball, the one after a locked ball. It varies at random. The player launches only the
    balls that he starts; without this key, all."""
    auto_delay: Annotated[float, Quantity(0.1, 10.0, "s"), SINCE_2] = 1.0
    """[s] how long such a ball lies there before."""

    @model_validator(mode="after")
    def _delays_something(self) -> Self:
        if self.auto_launch is None and "auto_delay" in self.model_fields_set:
            refuse("must not have `auto_delay` without `auto_launch`, for example auto_launch = [18, 20]")
        return self

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one disc, as large as a ball, that holds a ball."""
        # 90° is exact, whatever the functions say about π/2.
        sine, cosine = (1.0, 0.0) if self.angle == 90.0 else sine_cosine(math.radians(self.angle))
        return (
            Primitive(
                Shape.DISC,
                (self.position,),
                board.ball_radius,
                response=Response.HOLD,
                finish=Finish.PLUNGER,
                levels=self.all_levels,
                launch=Launch(
                    self.launch[0],
                    self.launch[1],
                    self.charge,
                    (sine, cosine),
                    self.auto_launch,
                    self.auto_delay,
                ),
            ),
        )
