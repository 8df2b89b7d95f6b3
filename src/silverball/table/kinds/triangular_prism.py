"""Triangular prisms: obstacles with a triangular footprint."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Self

from pydantic import Field, model_validator

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Solid
from silverball.table.model import (
    SINCE_2,
    Corners,
    Falloff,
    Kick,
    Model,
    Outline,
    Place,
    Points,
    Radius,
    Restitution,
    SineCosine,
    SpeedFactor,
    Triangle,
    libm,
)
from silverball.table.primitive import Finish, Primitive
from silverball.table.quantity import Quantity, refuse


class PrismSurface(Model):
    """The surface of a triangular prism, which slows a ball down."""

    restitution: Restitution = 0.8
    """Restitution at a slow contact."""
    restitution_falloff: Falloff = 0.0
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    speed_factor: SpeedFactor = 0.85
    """At a hit, the whole velocity after the bounce is multiplied by this; below 1 it slows the ball."""
    points: Points = 50
    """Points for a hit."""


class TriangularPrism(PrismSurface, Solid):
    """An obstacle with a triangular footprint.

    Give exactly one of: `vertices`; or `center` and `size` (and `rotation`) for an equilateral one; or
    `mesh`, whose footprint becomes the `vertices` when the table file is loaded.
    """

    vertices: Corners | None = None
    """[u] the three corners, each [x, z], in any order."""
    center: Place | None = None
    """[u] the centre of an equilateral footprint, [x, z]."""
    size: Radius | None = None
    """[u] circumradius of an equilateral footprint."""
    rotation: Annotated[float, Quantity(-360.0, 360.0, "deg")] = 0.0
    """[deg] direction from the centre to the first corner of an equilateral footprint."""
    mesh: Annotated[str, Field(min_length=1, max_length=1000)] | None = None
    """An STL, OBJ or GLB file, relative to the table file."""
    kick: Annotated[Kick, SINCE_2] = 0.0
    """[u/s] speed that a hit adds along the normal."""

    own_finish = Finish.PRISM

    @model_validator(mode="after")
    def _one_shape(self) -> Self:
        has_rotation = "rotation" in self.model_fields_set
        given = [
            key
            for key, is_given in (
                ("vertices", self.vertices is not None),
                ("center", self.center is not None or self.size is not None or has_rotation),
                ("mesh", self.mesh is not None),
            )
            if is_given
        ]
        forms = "`vertices`, or `center` with `size` and `rotation`, or `mesh`"
        if len(given) != 1:
            refuse(f"needs exactly one of {forms}, got {' and '.join(given) if given else 'none of them'}")
        if given == ["center"] and (self.center is None or self.size is None):
            refuse(
                f"needs `{'center' if self.center is None else 'size'}` too: an equilateral prism has both"
            )
        return self

    @property
    def mesh_file(self) -> str | None:
        """The mesh file that gives the prism its shape, if any."""
        return self.mesh

    def footprint(self, path: Path) -> dict[str, Triangle]:
        """Return the vertices that a mesh gives to the prism."""
        from silverball.table.mesh import triangle_footprint

        return {"vertices": triangle_footprint(path)}

    def corners(self, sine_cosine: SineCosine = libm) -> Triangle:
        """Return the three corners (x, z) [u], counter-clockwise, however the prism was specified.

        Args:
            sine_cosine: The functions that turn an equilateral prism. The physics passes its own, which give
                the same bits on every machine.
        """
        if self.vertices is not None:
            return _counter_clockwise(self.vertices)
        if self.mesh is not None:
            return self.resolved().corners()
        assert self.center is not None
        assert self.size is not None
        x, z = self.center
        angles = (sine_cosine(math.radians(self.rotation + third)) for third in (0.0, 120.0, 240.0))
        a, b, c = ((x + self.size * sine, z + self.size * cosine) for sine, cosine in angles)
        return (a, b, c)

    def outline(self) -> Outline:
        """The corners as a core, without a radius."""
        return self.corners(), 0.0

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one triangle."""
        del board
        return (
            Primitive(
                Shape.TRIANGLE,
                self.corners(sine_cosine),
                surface=self.surface(self.kick),
                finish=self.shown_finish,
                levels=self.all_levels,
            ),
        )


def _counter_clockwise(corners: Triangle) -> Triangle:
    """Return the corners counter-clockwise: Σ(zᵢ·xᵢ₊₁ − xᵢ·zᵢ₊₁) > 0 with z to the right and x up."""
    a, b, c = corners
    # The sum relative to corner a: the same value, without cancellation far from the origin.
    turn = (b[1] - a[1]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[1] - a[1])
    return (a, b, c) if turn >= 0.0 else (a, c, b)
