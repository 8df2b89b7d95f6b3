"""The bases of the kinds of parts: what all parts, solid parts and parts along a line have in common."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import ValidationInfo, field_validator

from silverball.table.kinds.board import LEVELS, Board
from silverball.table.model import (
    SINCE_2,
    Falloff,
    Friction,
    HitSpeed,
    Model,
    Name,
    Place,
    Points,
    Restitution,
    SineCosine,
    SpeedFactor,
    libm,
)
from silverball.table.primitive import Finish, Point, Primitive, Surface
from silverball.table.quantity import Count, ItemList, refuse

MIN_LENGTH = 1e-3  # [u] of a line or an edge; chosen: far above rounding

LevelNumber = Annotated[int, Count(0, LEVELS - 1)]
SolidFinish = Literal["wall", "metal", "wood", "plastic", "rubber", "prism", "bumper", "target"]
"""The finishes that a solid part may choose."""


class Part(Model):
    """The base of all parts of a table."""

    name: Name = ""
    """A name for people and rules; in format 2 no two parts share one."""
    level: Annotated[LevelNumber, SINCE_2] = 0
    """The level on which the part is: balls on other levels do not meet it."""
    levels: Annotated[
        Annotated[tuple[int, ...], ItemList(Count(0, LEVELS - 1), LEVELS, "[0, 1]")] | None, SINCE_2
    ] = None
    """The levels on which the part is, in place of `level`, if they are several."""

    @field_validator("levels")
    @classmethod
    def _in_order(cls, levels: tuple[int, ...] | None, info: ValidationInfo) -> tuple[int, ...] | None:
        if levels is None:
            return None
        if info.data.get("level"):
            refuse("must not be given beside `level`: one of the two is enough")
        return tuple(sorted(set(levels)))

    @property
    def all_levels(self) -> tuple[int, ...]:
        """The levels on which balls meet the part, in order."""
        return (self.level,) if self.levels is None else self.levels

    @property
    def worth(self) -> int:
        """The points for a hit."""
        return 0

    @property
    def mesh_file(self) -> str | None:
        """The mesh file that gives the part its shape, if any."""
        return None

    def resolved(self, folder: Path | None = None) -> Self:
        """Return the part with its mesh, if any, replaced by the footprint.

        Args:
            folder: Where to look for the mesh; the current folder by default.

        Raises:
            TableError: The mesh cannot be read or used.
        """
        if self.mesh_file is None:
            return self
        return self.model_copy(update={"mesh": None, **self.footprint((folder or Path()) / self.mesh_file)})

    def footprint(self, path: Path) -> Mapping[str, Any]:
        """Return the fields that a mesh gives to the part; only for kinds that have a `mesh`."""
        raise NotImplementedError

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return what the part is made of.

        Args:
            board: The board on which it lies.
            sine_cosine: The functions that turn it. The physics passes its own, which give the same bits on
                every machine.
        """
        raise NotImplementedError


class Scored(Part):
    """The base of the parts that give `points`."""

    points: Points = 0
    """Points for a hit."""

    @property
    def worth(self) -> int:
        """The points for a hit."""
        return self.points


class Bouncing(Part):
    """The base of the parts off which a ball bounces."""

    restitution: Restitution = 0.7
    """Restitution at a slow contact."""
    restitution_falloff: Falloff = 0.0
    """[s/u] k in e = restitution / (1 + k·|v|), v the relative normal speed."""
    speed_factor: Annotated[SpeedFactor, SINCE_2] = 1.0
    """At a hit, the whole velocity after the bounce is multiplied by this."""
    friction: Annotated[Friction | None, SINCE_2] = None
    """Coefficient of friction at the part; by default that of the board."""
    hit_speed: Annotated[HitSpeed | None, SINCE_2] = None
    """[u/s] an impact above it is a hit, below it a touch; by default that of the board."""
    finish: Annotated[SolidFinish | None, SINCE_2] = None
    """What it looks and sounds like; by default as usual for its kind."""

    own_finish: ClassVar[Finish] = Finish.WALL

    @property
    def shown_finish(self) -> Finish:
        """What the part looks and sounds like."""
        return self.own_finish if self.finish is None else Finish(self.finish)

    def surface(self, kick: float = 0.0, kick_profile: str = "flat") -> Surface:
        """Return how the part bounces a ball, with a kick along the normal [u/s] at a hit."""
        return Surface(
            restitution=self.restitution,
            restitution_falloff=self.restitution_falloff,
            speed_factor=self.speed_factor,
            friction=self.friction,
            hit_speed=self.hit_speed,
            kick=kick,
            kick_profile=kick_profile,
            points=self.worth,
        )


class Solid(Scored, Bouncing):
    """The base of the parts off which a ball bounces, and that give points."""


class Line(Part):
    """The base of the parts along a line between two points."""

    start: Place
    """[u] one end, [x, z]."""
    end: Place
    """[u] the other end, [x, z]."""

    @field_validator("end")
    @classmethod
    def _has_length(cls, end: Point, info: ValidationInfo) -> Point:
        start = info.data.get("start")
        if start is not None and math.dist(start, end) < MIN_LENGTH:
            refuse(f"must be at least {MIN_LENGTH:g} u away from start, got [{end[0]:g}, {end[1]:g}]")
        return end

    @property
    def left_normal(self) -> Point:
        """The unit normal (x, z) to the left of start → end, as the player sees it."""
        return left_normal(self.start, self.end)


def left_normal(start: Point, end: Point) -> Point:
    """Return the unit normal (x, z) to the left of start → end, as the player sees it."""
    dx, dz = end[0] - start[0], end[1] - start[1]
    length = math.sqrt(dx * dx + dz * dz)  # not hypot, whose last bit differs between systems
    return dz / length, -dx / length


def in_order(model: type[Model]) -> list[str]:
    """Return the fields of a model as a file lists them: the name, what is its own, what all parts have."""
    common: set[str] = set()
    for base in (Part, Bouncing, Scored):
        common |= set(base.model_fields) if issubclass(model, base) else set()
    return sorted(model.model_fields, key=lambda name: (name != "name", name in common))
