"""Walls: chains of straight edges and arcs, open or closed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import Field, model_validator
from pydantic.json_schema import JsonSchemaValue

from silverball.physics.forms import Shape
from silverball.table.kinds.board import Board
from silverball.table.kinds.part import Bouncing
from silverball.table.model import Kick, Points, Restitution, SineCosine, Thickness, libm
from silverball.table.primitive import Primitive
from silverball.table.quantity import POINT, Count, ItemList, Quantity, Rule, refuse, shown

MAX_POINTS = 1000  # of one wall; real tables have 110
MIN_EDGE = 1e-6  # [u]
MIN_BULGE = 1e-3  # a flatter arc has a radius of 250 chords: too large to be exact

ChainPoint: TypeAlias = tuple[float, float] | tuple[float, float, float]
"""[x, z] or [x, z, bulge]."""


@dataclass(frozen=True)
class _ChainPoint(Rule):
    """A point of a wall: [x, z], or [x, z, bulge] where an arc follows."""

    def check(self, value: Any) -> ChainPoint:
        if not isinstance(value, list | tuple) or len(value) != 3:
            if not isinstance(value, list | tuple) or len(value) != 2:
                refuse(f"must be written [[x, z], [x, z, bulge], …], got a point {shown(value)}")
            x, z = POINT.check(value)
            return x, z
        x, z = POINT.check(value[:2])
        bulge = Quantity(-5.0, 5.0).check(value[2])
        if bulge == 0.0:
            return x, z
        if abs(bulge) < MIN_BULGE:
            refuse(f"must have bulges of 0 or at least ±{MIN_BULGE:g}, got {bulge:g}: leave it out")
        return x, z, bulge

    def json_schema(self) -> JsonSchemaValue:
        number = {"type": "number"}
        return {"type": "array", "items": number, "minItems": 2, "maxItems": 3}


class Wall(Bouncing):
    """A wall along any number of points, with rounded ends and corners; a closed one is solid inside.

    Between two points it runs straight, or along an arc if the first of them has a bulge, tan(angle/4) of the
    arc: 1 is half a circle, 0.414 a quarter; positive is counter-clockwise from this point to the next.
    """

    points: Annotated[
        tuple[ChainPoint, ...], ItemList(_ChainPoint(), MAX_POINTS, "[[x, z], [x, z], …]", least=2)
    ]
    """[u] the corners in order, [x, z] or [x, z, bulge]."""
    closed: Annotated[bool, Field(strict=True)] = False
    """Whether the last point is joined to the first; the inside is then solid."""
    thickness: Thickness = 0.05
    """[u] from the line to the surface, on both sides and around the ends."""
    kick: Kick = 0.0
    """[u/s] speed that a hit adds along the normal, on the edges that kick."""
    edges: Annotated[tuple[int, ...], ItemList(Count(0, MAX_POINTS - 1), MAX_POINTS, "[0, 2]", least=0)] = ()
    """The edges that kick, counted from 0; edge 0 runs from the first point to the second. By default all."""
    kick_profile: Literal["flat", "parabola"] = "parabola"
    """The kick along a straight edge: the same everywhere, or strongest in the middle, none at the ends."""
    score: Points = 0
    """Points for a hit; other parts call it `points`."""
    restitution: Restitution = 0.4
    """Restitution at a slow contact."""

    @model_validator(mode="after")
    def _is_a_chain(self) -> Self:
        corners = [(point[0], point[1]) for point in self.points]
        last = len(corners) if self.closed else len(corners) - 1
        for index in range(last):
            if math.dist(corners[index], corners[(index + 1) % len(corners)]) < MIN_EDGE:
                x, z = corners[index]
                remedy = "`closed` joins the ends by itself" if index == len(corners) - 1 else "leave one out"
                refuse(f"must not repeat a point, got [{x:g}, {z:g}] twice in a row: {remedy}")
        if self.closed and len(corners) == 2 and not any(len(point) == 3 for point in self.points):
            refuse("must have three points or an arc: it is closed")
        if not self.closed and len(self.points[-1]) == 3:
            refuse("must not have a bulge at its last point: no arc follows; or give closed = true")
        if any(edge >= last for edge in self.edges):
            refuse(f"has edges 0 to {last - 1}, got {shown(list(self.edges))}")
        if self.edges and not self.kick:
            refuse("must have a `kick` above 0 for its `edges`")
        return self

    @property
    def worth(self) -> int:
        """The points for a hit."""
        return self.score

    def primitives(self, board: Board, sine_cosine: SineCosine = libm) -> tuple[Primitive, ...]:
        """Return a capsule or an arc for each edge, in order."""
        del board, sine_cosine
        plain = self.surface()
        kicking = self.surface(self.kick, self.kick_profile)
        edges: list[Primitive] = []
        for index in range(len(self.points) if self.closed else len(self.points) - 1):
            x, z, *bulge = self.points[index]
            end = self.points[(index + 1) % len(self.points)]
            edges.append(
                Primitive(
                    Shape.ARC if bulge else Shape.CAPSULE,
                    ((x, z), (end[0], end[1])),
                    self.thickness,
                    bulge=bulge[0] if bulge else 0.0,
                    surface=kicking if self.kick and (not self.edges or index in self.edges) else plain,
                    finish=self.shown_finish,
                    levels=self.all_levels,
                )
            )
        return tuple(edges)
