"""Spinners: blades that a passing ball sets in rotation."""

from __future__ import annotations

from typing import Annotated

from silverball.physics.forms import Response, Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Line, Scored
from silverball.table.model import Points, SineCosine, libm
from silverball.table.primitive import Finish, Primitive, Spin, Surface
from silverball.table.quantity import Quantity


class Spinner(Line, Scored):
    """A hinged blade over a line; a ball that crosses it sets it turning, and every turn gives points."""

    damping: Annotated[float, Quantity(0.05, 50.0, "1/s")] = 2.0
    """[1/s] rate at which its speed decays."""
    drag: Annotated[float, Quantity(0.0, 20.0, "u/s")] = 0.0
    """[u/s] speed that it takes from a ball."""
    height: Annotated[float, Quantity(0.05, 2.0, "u")] = 0.3
    """[u] half of the blade's height: the radius at which a ball meets it."""
    points: Points = 25
    """Points for a turn."""

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one line that a ball passes."""
        del board, sine_cosine
        return (
            Primitive(
                Shape.LINE,
                (self.start, self.end),
                response=Response.PASS,
                surface=Surface(points=self.worth),
                finish=Finish.SPINNER,
                levels=self.all_levels,
                spin=Spin(self.damping, self.drag, self.height),
            ),
        )
