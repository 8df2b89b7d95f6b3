"""Slingshots: rubber bands between two posts, which kick a ball away."""

from __future__ import annotations

from typing import Annotated

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Line, Solid
from silverball.table.model import (
    SINCE_2,
    Falloff,
    HitSpeed,
    Kick,
    Points,
    Restitution,
    SineCosine,
    Thickness,
    libm,
)
from silverball.table.primitive import Finish, Primitive
from silverball.table.quantity import Quantity


class Slingshot(Line, Solid):
    """A rubber band between two posts; a hit on it kicks the ball away, hardest in the middle.

    It kicks on both sides, so close its back with a wall.
    """

    kick: Kick = 12.0
    """[u/s] speed that a hit in the middle adds along the normal; at the ends there is none."""
    thickness: Thickness = 0.05
    """[u] from the middle of the band to its surface."""
    post_radius: Annotated[float, Quantity(0.02, 2.0, "u")] = 0.12
    """[u] radius of the posts at its ends."""
    hit_speed: Annotated[HitSpeed, SINCE_2] = 2.0
    """[u/s] an impact above it is a hit, and only a hit kicks."""
    restitution: Restitution = 0.8
    """Restitution at a slow contact."""
    restitution_falloff: Falloff = 0.01
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    points: Points = 10
    """Points for a hit."""

    own_finish = Finish.RUBBER

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return a capsule that kicks, and two circles."""
        del board, sine_cosine
        band = Primitive(
            Shape.CAPSULE,
            (self.start, self.end),
            self.thickness,
            surface=self.surface(self.kick, "parabola"),
            finish=self.shown_finish,
            levels=self.all_levels,
        )
        post = band._replace(shape=Shape.CIRCLE, radius=self.post_radius, surface=self.surface())
        return band, post._replace(points=(self.start,)), post._replace(points=(self.end,))
