"""Distance of a point from a shape, and the unit normal there.

Each function returns the distance [u] of the point (x, z) from the shape's surface (negative inside) and the
unit normal, which points from the nearest feature to the point. The solver needs nothing else from a
convex shape: corners act as if rounded, and the tip of a paddle needs no normal of its own. An arc is not
convex: a ball can touch both of its ends at once (see `arc_contact`).
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import BallRecord, ColliderRecord, Shape
from silverball.physics.tolerances import MAX_DEPTH


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
    """Compute the distance from a circle: that from its centre, less its radius."""
    distance, nx, nz = point_distance(x, z, c.x, c.z)
    return distance - c.radius, nx, nz


@internal
def segment_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from a capsule: a segment from corner 0 to corner 1, rounded by its radius.

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


@internal
def tapered_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from a tapered capsule in its own frame: base at the origin, tip along z.

    It is the convex hull of two circles, with the radius r₀ at the base and r₁ at the distance L. Its flanks
    touch both circles; with s = (r₀ − r₁)/L and c = √(1 − s²) a flank has the normal (±c, s) and the
    direction (∓s, c). So w = z·c − |x|·s is the place along the flank: the base is nearest for w ≤ 0, the
    tip for w ≥ c·L.
    """
    side = 1.0 if x >= 0.0 else -1.0
    across = abs(x)
    along = z * c.taper_cosine - across * c.taper_sine
    if along <= 0.0:
        gap, nx, nz = point_distance(across, z, 0.0, 0.0)
        return gap - c.radius, side * nx, nz
    if along >= c.taper_cosine * c.length0:
        gap, nx, nz = point_distance(across, z, 0.0, c.length0)
        return gap - c.tip_radius, side * nx, nz
    gap = across * c.taper_cosine + z * c.taper_sine - c.radius
    return gap, side * c.taper_cosine, c.taper_sine


@inlined
def is_beside_arc(c: ColliderRecord, x: float, z: float) -> bool:
    """Whether the direction of (x, z) from the centre of an arc lies within the arc's angle."""
    after_start = (x - c.x0) * c.along_x0 + (z - c.z0) * c.along_z0 >= 0.0
    before_end = (x - c.x1) * c.along_x1 + (z - c.z1) * c.along_z1 >= 0.0
    return (after_start or before_end) if c.arc_is_major != 0 else (after_start and before_end)


@inlined
def _circle_of_arc_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from the circle of an arc, negative inside, and the outward unit normal.

    With q from the centre and e from there to the start, |q| − R is (|q|² − |e|²) / (|q| + R), and the
    difference of squares is d·(d + 2e), d = q − e: exact also for very flat arcs, whose centre is far away.
    """
    from_center, nx, nz = point_distance(x, z, c.x2, c.z2)
    if from_center == 0.0:  # all points of the arc are equally near
        nx, nz = c.inward_x, c.inward_z
    dx, dz = x - c.x0, z - c.z0
    square = dx * (dx + 2.0 * (c.x0 - c.x2)) + dz * (dz + 2.0 * (c.z0 - c.z2))
    return square / (from_center + c.arc_radius), nx, nz


@internal
def arc_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from an arc, rounded by its radius.

    Within the angle of the arc the nearest point is on its circle, in the same direction from the centre.
    Elsewhere it is the nearer end.
    """
    if is_beside_arc(c, x, z):
        gap, nx, nz = _circle_of_arc_distance(c, x, z)
        if gap < 0.0:
            gap, nx, nz = -gap, -nx, -nz
        return gap - c.radius, nx, nz
    start, start_x, start_z = point_distance(x, z, c.x0, c.z0)
    end, end_x, end_z = point_distance(x, z, c.x1, c.z1)
    if start <= end:
        return start - c.radius, start_x, start_z
    return end - c.radius, end_x, end_z


@internal
def arc_contact(c: ColliderRecord, x: float, z: float, vx: float, vz: float) -> tuple[float, float, float]:
    """Compute the distance from an arc as `arc_distance` does, for a ball with the velocity (vx, vz).

    A ball that leaves one end and runs into the other one, at the same distance but for rounding, is measured
    from the latter.
    """
    if is_beside_arc(c, x, z):
        return arc_distance(c, x, z)
    near, near_x, near_z = point_distance(x, z, c.x0, c.z0)
    far, far_x, far_z = point_distance(x, z, c.x1, c.z1)
    if far < near:
        near, near_x, near_z, far, far_x, far_z = far, far_x, far_z, near, near_x, near_z
    if far - near < MAX_DEPTH and near_x * vx + near_z * vz >= 0.0 and far_x * vx + far_z * vz < 0.0:
        return far - c.radius, far_x, far_z
    return near - c.radius, near_x, near_z


@kernel
def distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from a stationary shape of any kind, but for the planes of the borders."""
    if c.form == Shape.CIRCLE:
        return circle_distance(c, x, z)
    if c.form == Shape.CAPSULE:
        return segment_distance(c, x, z)
    if c.form == Shape.TRIANGLE:
        return triangle_distance(c, x, z)
    if c.form == Shape.ARC:
        return arc_distance(c, x, z)
    if c.form == Shape.DISC:
        return circle_distance(c, x, z)
    return segment_distance(c, x, z)  # a line


@inlined
def contact_normal(c: ColliderRecord, ball: BallRecord) -> tuple[float, float]:
    """Compute the unit normal from a stationary shape to a ball that touches it."""
    if c.form == Shape.ARC:
        _, nx, nz = arc_contact(c, ball.x, ball.z, ball.vx, ball.vz)
    else:
        _, nx, nz = distance(c, ball.x, ball.z)
    return nx, nz
