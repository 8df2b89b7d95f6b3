"""Distance of a point from a shape, and the unit normal there.

Each function returns the distance [u] of the point (x, z) from the shape's surface (negative inside) and the
unit normal, which points from the nearest feature to the point. The solver needs nothing else from a
shape: corners act as if rounded, and the tip of a paddle needs no normal of its own.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import ColliderRecord, Kind


class Side(NamedTuple):
    """A side of a triangle: from p to q [u], its unit direction u, its length [u]."""

    px: float
    pz: float
    qx: float
    qz: float
    ux: float
    uz: float
    length: float


@inlined
def point_distance(x: float, z: float, px: float, pz: float) -> tuple[float, float, float]:
    """Compute the distance of (x, z) from the point (px, pz);  n = (p − q) / |p − q|."""
    dx = x - px
    dz = z - pz
    distance = sqrt(dx * dx + dz * dz)
    if distance == 0.0:
        return 0.0, 1.0, 0.0  # any direction works; this one is its own mirror image
    return distance, dx / distance, dz / distance


@inlined
def circle_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from a cylinder: that from its centre, less its radius."""
    distance, nx, nz = point_distance(x, z, c.x, c.z)
    return distance - c.radius, nx, nz


@internal
def segment_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from a slant wall: a segment from corner 0 to corner 1, rounded by its thickness.

    With t = (p − p₀)·u the foot of the point on the line, the nearest point is an end (t ≤ 0, t ≥ length)
    or lies between.
    """
    dx = x - c.x0
    dz = z - c.z0
    foot = dx * c.along_x0 + dz * c.along_z0
    if foot <= 0.0:
        distance, nx, nz = point_distance(x, z, c.x0, c.z0)
    elif foot >= c.length0:
        distance, nx, nz = point_distance(x, z, c.x1, c.z1)
    else:
        distance = dx * c.inward_x + dz * c.inward_z
        nx, nz = c.inward_x, c.inward_z
        if distance < 0.0:
            distance, nx, nz = -distance, -nx, -nz
    return distance - c.radius, nx, nz


@internal
def triangle_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from a triangle with counter-clockwise corners.

    A side with direction u has the outward normal n = (−u_z, u_x) in (x, z). The side that the point lies
    furthest outside of holds the nearest feature: the side itself, or one of its ends.
    """
    side, best = 0, (x - c.x0) * -c.along_z0 + (z - c.z0) * c.along_x0
    outside = (x - c.x1) * -c.along_z1 + (z - c.z1) * c.along_x1
    if outside > best:
        side, best = 1, outside
    outside = (x - c.x2) * -c.along_z2 + (z - c.z2) * c.along_x2
    if outside > best:
        side, best = 2, outside
    if side == 0:
        return _side_distance(best, x, z, Side(c.x0, c.z0, c.x1, c.z1, c.along_x0, c.along_z0, c.length0))
    if side == 1:
        return _side_distance(best, x, z, Side(c.x1, c.z1, c.x2, c.z2, c.along_x1, c.along_z1, c.length1))
    return _side_distance(best, x, z, Side(c.x2, c.z2, c.x0, c.z0, c.along_x2, c.along_z2, c.length2))


@inlined
def _side_distance(outside: float, x: float, z: float, side: Side) -> tuple[float, float, float]:
    """Compute the distance from a side or its ends, for a point `outside` away from the side's line."""
    foot = (x - side.px) * side.ux + (z - side.pz) * side.uz
    if outside > 0.0:
        if foot < 0.0:
            return point_distance(x, z, side.px, side.pz)
        if foot > side.length:
            return point_distance(x, z, side.qx, side.qz)
    return outside, -side.uz, side.ux


@kernel
def distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from a stationary shape of any kind."""
    if c.kind == Kind.CYLINDER:
        return circle_distance(c, x, z)
    if c.kind == Kind.SLANT_WALL:
        return segment_distance(c, x, z)
    return triangle_distance(c, x, z)
