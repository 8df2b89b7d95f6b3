"""Paths along primitives, and the areas that chains of them enclose."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from silverball.physics.forms import Shape
from silverball.table.primitive import Point, Primitive, arc_of

ARC_STEP = math.radians(12.0)  # between two points along an arc
SAME_POINT = 1e-6  # [u] ends of two edges this close are one corner


def path(primitive: Primitive) -> list[Point]:
    """Return points along a CAPSULE, LINE or ARC, from start to end."""
    start, end = primitive.points
    if primitive.shape != Shape.ARC:
        return [start, end]
    center, radius, _, half_angle, _ = arc_of(start, end, primitive.bulge)
    count = max(math.ceil(2.0 * half_angle / ARC_STEP), 2)
    first = math.atan2(start[0] - center[0], start[1] - center[1])
    turn = math.copysign(2.0 * half_angle / count, primitive.bulge)
    between = (first + step * turn for step in range(1, count))
    inner = [
        (center[0] + radius * math.sin(angle), center[1] + radius * math.cos(angle)) for angle in between
    ]
    return [start, *inner, end]


def closed_outline(primitives: Sequence[Primitive]) -> tuple[Point, ...] | None:
    """Return the corners of the area that the primitives of a part enclose; None if they are no closed chain.

    Arcs are followed by corners at small angles.
    """
    if len(primitives) < 2 or any(p.shape not in (Shape.CAPSULE, Shape.ARC) for p in primitives):
        return None
    for first, second in pairwise((*primitives, primitives[0])):
        if math.dist(first.points[1], second.points[0]) > SAME_POINT:
            return None
    corners = tuple(corner for primitive in primitives for corner in path(primitive)[:-1])
    return corners if len(corners) > 2 else None
