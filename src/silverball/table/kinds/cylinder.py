"""Cylinders: round obstacles; the trade says bumper."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Solid
from silverball.table.model import (
    SINCE_2,
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
    libm,
)
from silverball.table.primitive import Finish, Primitive
from silverball.table.quantity import refuse


class CylinderSurface(Model):
    """The surface of a cylinder, which speeds a ball up."""

    restitution: Restitution = 0.9
    """Restitution at a slow contact."""
    restitution_falloff: Falloff = 0.0
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    speed_factor: SpeedFactor = 1.25
    """At a hit, the whole velocity after the bounce is multiplied by this; above 1 it boosts the ball."""
    points: Points = 100
    """Points for a hit."""


class Cylinder(CylinderSurface, Solid):
    """A round obstacle: `center` and `radius`, or a `mesh` whose footprint gives both when loaded."""

    center: Place | None = None
    """[u] the centre, [x, z]."""
    radius: Radius | None = None
    """[u] from the centre to the surface."""
    mesh: Annotated[str, Field(min_length=1, max_length=1000)] | None = None
    """An STL, OBJ or GLB file, relative to the table file."""
    kick: Annotated[Kick, SINCE_2] = 0.0
    """[u/s] speed that a hit adds along the normal."""

    own_finish = Finish.BUMPER

    @model_validator(mode="after")
    def _one_shape(self) -> Self:
        given = [key for key in ("center", "radius") if getattr(self, key) is not None]
        if self.mesh is not None and given:
            refuse(f"needs either `mesh` or `center` and `radius`, got mesh and {' and '.join(given)}")
        if self.mesh is None and len(given) < 2:
            missing = " and ".join(f"`{key}`" for key in ("center", "radius") if key not in given)
            refuse(f"needs {missing}: a cylinder has `center` and `radius`, or a `mesh`")
        return self

    @property
    def mesh_file(self) -> str | None:
        """The mesh file that gives the cylinder its shape, if any."""
        return self.mesh

    def footprint(self, path: Path) -> dict[str, Any]:
        """Return the centre and the radius that a mesh gives to the cylinder."""
        from silverball.table.mesh import circle_footprint

        x, z, radius = circle_footprint(path)
        return {"center": (x, z), "radius": radius}

    def circle(self) -> tuple[float, float, float]:
        """Return the footprint: x and z of the centre, and the radius [u]."""
        if self.mesh is not None:
            return self.resolved().circle()
        assert self.center is not None
        assert self.radius is not None
        return (*self.center, self.radius)

    def outline(self) -> Outline:
        """The centre as a core, and the radius."""
        x, z, radius = self.circle()
        return ((x, z), (x, z), (x, z)), radius

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return one circle."""
        del board, sine_cosine
        x, z, radius = self.circle()
        return (
            Primitive(
                Shape.CIRCLE,
                ((x, z),),
                radius,
                surface=self.surface(self.kick),
                finish=self.shown_finish,
                levels=self.all_levels,
            ),
        )
