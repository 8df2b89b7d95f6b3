"""Slant walls: between two points, at any angle."""

from __future__ import annotations

import math
from typing import Annotated

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Solid
from silverball.table.model import SINCE_2, Kick, Outline, Place, SineCosine, Thickness, libm
from silverball.table.primitive import Point, Primitive


class SlantWall(Solid):
    """A wall between two points, at any angle, with rounded ends; a ball can hit it from both sides."""

    start: Place
    """[u] one end, [x, z]."""
    end: Place
    """[u] the other end, [x, z]; the order of the two does not matter."""
    thickness: Thickness = 0.1
    """[u] from the line between the ends to the surface, on both sides and around the ends."""
    kick: Annotated[Kick, SINCE_2] = 0.0
    """[u/s] speed that a hit adds along the normal."""

    def outline(self) -> Outline:
        """The two ends as a core, and the thickness as its radius."""
        return (self.start, self.end, self.end), self.thickness

    def inward_normal(self, board: Board) -> Point:
        """Return the unit normal (x, z) that points towards the board's centre, for either order of the ends.

        If the line of the wall passes through the centre, the normal points up, or right for a vertical wall.

        Raises:
            ValueError: The two ends are the same point.
        """
        dx, dz = self.end[0] - self.start[0], self.end[1] - self.start[1]
        length = math.sqrt(dx * dx + dz * dz)  # not hypot, whose last bit differs between systems
        if length == 0.0:
            raise ValueError("a slant wall whose two ends are the same point has no normal")
        nx, nz = dz / length, -dx / length
        side = nx * (board.center[0] - self.start[0]) + nz * (board.center[1] - self.start[1])
        if abs(side) < 1e-12:  # [u] through the centre, but for rounding
            side = nx if nx != 0.0 else nz
        return (nx, nz) if side > 0.0 else (-nx, -nz)

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one capsule."""
        del board, sine_cosine
        return (
            Primitive(
                Shape.CAPSULE,
                (self.start, self.end),
                self.thickness,
                surface=self.surface(self.kick),
                finish=self.shown_finish,
                levels=self.all_levels,
            ),
        )
