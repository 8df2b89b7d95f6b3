"""Rollovers: lanes and buttons that notice a ball without touching it."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator

from silverball.physics.forms import Response, Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import MIN_LENGTH, Scored
from silverball.table.model import Place, Points, SineCosine, libm
from silverball.table.primitive import Finish, Point, Primitive, Surface
from silverball.table.quantity import Quantity, refuse


class Rollover(Scored):
    """A switch in the playfield that notices a ball, which rolls on as if nothing were there.

    Give `start` and `end` of a line that the ball's centre crosses, or `center` and `radius` of a circle that
    it enters.
    """

    start: Place | None = None
    """[u] one end of a line, [x, z]."""
    end: Place | None = None
    """[u] the other end of a line, [x, z]."""
    center: Place | None = None
    """[u] the centre of a circle, [x, z]."""
    radius: Annotated[float, Quantity(0.05, 5.0, "u")] | None = None
    """[u] radius of a circle."""
    points: Points = 50
    """Points for a crossing."""

    @model_validator(mode="after")
    def _line_or_circle(self) -> Self:
        line = (self.start is not None) + (self.end is not None)
        circle = (self.center is not None) + (self.radius is not None)
        if (line, circle) not in ((2, 0), (0, 2)):
            refuse("needs `start` and `end` of a line, or `center` and `radius` of a circle")
        if self.start is not None and self.end is not None:
            (ax, az), (bx, bz) = self.start, self.end
            if abs(bx - ax) + abs(bz - az) < MIN_LENGTH:
                refuse(f"must have ends that are at least {MIN_LENGTH:g} u apart")
        return self

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one line or disc that a ball passes."""
        del board, sine_cosine
        points: tuple[Point, ...]
        if self.start is not None and self.end is not None:
            points = (self.start, self.end)
        else:
            assert self.center is not None
            points = (self.center,)
        return (
            Primitive(
                Shape.DISC if len(points) == 1 else Shape.LINE,
                points,
                self.radius or 0.0,
                response=Response.PASS,
                surface=Surface(points=self.worth),
                finish=Finish.ROLLOVER,
                levels=self.all_levels,
            ),
        )
