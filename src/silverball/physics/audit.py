"""Audit: how deep a ball is inside a part, computed without any code of the solver.

The solver trusts `shapes.py`; this check does not. It uses a part's corners alone, turns a paddle's with
the C library's sine, finds the nearest point of each side by clamping the foot, and tells inside from outside
by the signs of three cross products. A part whose bounding box is further away than a ball's radius is
culled. It runs only in tests, soaks and `silverball simulate`.
"""

from __future__ import annotations

from math import cos, hypot, inf, sin, sqrt

from silverball.physics.kernel import inlined, kernel
from silverball.physics.records import (
    MAX_BALLS,
    BoardRecord,
    ColliderRecord,
    Colliders,
    Kind,
    Part,
    WorldRecord,
)


@kernel
def side_gap(x: float, z: float, px: float, pz: float, qx: float, qz: float) -> float:
    """Compute the distance of (x, z) from the segment p → q by clamping the foot's share to 0 … 1."""
    wx, wz = qx - px, qz - pz
    share = ((x - px) * wx + (z - pz) * wz) / (wx * wx + wz * wz)
    share = min(1.0, max(0.0, share))
    return hypot(x - (px + share * wx), z - (pz + share * wz))


@kernel
def is_right_of(x: float, z: float, px: float, pz: float, qx: float, qz: float) -> bool:
    """Whether (x, z) lies to the right of the line p → q, as the player sees it."""
    return (qz - pz) * (x - px) - (qx - px) * (z - pz) < 0.0


@kernel
def corners_gap(
    x: float, z: float, px: float, pz: float, qx: float, qz: float, rx: float, rz: float
) -> float:
    """Compute the distance of (x, z) from the triangle p q r (counter-clockwise), negative inside."""
    near = min(side_gap(x, z, px, pz, qx, qz), side_gap(x, z, qx, qz, rx, rz), side_gap(x, z, rx, rz, px, pz))
    outside = (
        is_right_of(x, z, px, pz, qx, qz)
        or is_right_of(x, z, qx, qz, rx, rz)
        or is_right_of(x, z, rx, rz, px, pz)
    )
    return near if outside else -near


@kernel
def part_gap(c: ColliderRecord, angle: float, x: float, z: float) -> float:
    """Compute the distance of (x, z) from a part, a paddle at `angle` [rad]; infinite for a border."""
    if c.kind == Kind.CYLINDER:
        return hypot(x - c.x, z - c.z) - c.radius
    if c.kind == Kind.SLANT_WALL:
        return side_gap(x, z, c.x0, c.z0, c.x1, c.z1) - c.radius
    if c.kind == Kind.TRIANGULAR_PRISM:
        return corners_gap(x, z, c.x0, c.z0, c.x1, c.z1, c.x2, c.z2)
    if c.kind != Kind.PADDLE:
        return inf
    # Rotate the ball backwards instead of the three corners; the right paddle is mirrored.
    sine, cosine = sin(-angle), cos(-angle)
    dx, dz = x - c.x, (z - c.z) * c.side
    return corners_gap(cosine * dx + sine * dz, cosine * dz - sine * dx, c.x0, c.z0, c.x1, c.z1, c.x2, c.z2)


@kernel
def gap_to(c: ColliderRecord, part: int, angle: float, x: float, z: float) -> float:
    """Compute the distance of (x, z) from any part, borders included; `part` is its number on the board."""
    if part == Part.LEFT_WALL:
        return z - c.z
    if part == Part.RIGHT_WALL:
        return c.z - z
    if part == Part.TOP_WALL:
        return c.x - x
    return part_gap(c, angle, x, z)


@kernel
def box(c: ColliderRecord) -> tuple[float, float, float, float]:
    """Compute the bounding box of a stationary part: least and greatest x, least and greatest z [u]."""
    if c.kind == Kind.CYLINDER:
        return c.x - c.radius, c.x + c.radius, c.z - c.radius, c.z + c.radius
    low_x, high_x = min(c.x0, c.x1), max(c.x0, c.x1)
    low_z, high_z = min(c.z0, c.z1), max(c.z0, c.z1)
    if c.kind == Kind.SLANT_WALL:
        return low_x - c.radius, high_x + c.radius, low_z - c.radius, high_z + c.radius
    return min(low_x, c.x2), max(high_x, c.x2), min(low_z, c.z2), max(high_z, c.z2)


@inlined
def is_outside_box(c: ColliderRecord, x: float, z: float, radius: float) -> bool:
    """Whether (x, z) is further than `radius` from the bounding box of a stationary part."""
    low_x, high_x, low_z, high_z = box(c)
    return x < low_x - radius or x > high_x + radius or z < low_z - radius or z > high_z + radius


@inlined
def is_out_of_reach(c: ColliderRecord, x: float, z: float, radius: float) -> bool:
    """Whether (x, z) is further than `radius` from all that a paddle can sweep, or there is no paddle."""
    if c.kind != Kind.PADDLE:
        return True
    far = max(c.x0 * c.x0 + c.z0 * c.z0, c.x1 * c.x1 + c.z1 * c.z1, c.x2 * c.x2 + c.z2 * c.z2)
    reach = sqrt(far) + radius
    return (x - c.x) ** 2 + (z - c.z) ** 2 > reach * reach


@kernel
def depth_in_borders(board: BoardRecord, colliders: Colliders, x: float, z: float) -> float:
    """Compute how deep a ball at (x, z) is inside a border [u]; 0 if it is not."""
    first, radius = board.collider_first, board.ball_radius
    return max(
        0.0,
        colliders[first + Part.LEFT_WALL].z - (z - radius),
        (z + radius) - colliders[first + Part.RIGHT_WALL].z,
        (x + radius) - colliders[first + Part.TOP_WALL].x,
    )


@kernel
def depth_in_stationary(board: BoardRecord, colliders: Colliders, x: float, z: float) -> float:
    """Compute how deep a ball at (x, z) is inside a stationary part [u]; 0 if it is not."""
    depth, radius = 0.0, board.ball_radius
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        c = colliders[index]
        if not is_outside_box(c, x, z, radius):
            depth = max(depth, radius - part_gap(c, 0.0, x, z))
    return depth


@kernel
def depth_in_paddle(c: ColliderRecord, angle: float, x: float, z: float, radius: float) -> float:
    """Compute how deep a ball at (x, z) is inside a paddle at `angle` [rad]; 0 if it is not [u]."""
    if is_out_of_reach(c, x, z, radius):
        return 0.0
    return max(0.0, radius - part_gap(c, angle, x, z))


@kernel
def depth_in_other_ball(world: WorldRecord, radius: float) -> float:
    """Compute how deep any two balls are inside each other [u]; 0 if they are not."""
    depth = 0.0
    for other in range(1, MAX_BALLS):
        for one in range(other):
            a, b = world.ball[one], world.ball[other]
            if a.id != 0 and b.id != 0:
                depth = max(depth, 2.0 * radius - hypot(a.x - b.x, a.z - b.z))
    return depth


@kernel
def deepest(world: WorldRecord, board: BoardRecord, colliders: Colliders) -> float:
    """Compute how deep any ball is inside any part, border or other ball [u]; 0 if none is."""
    depth = depth_in_other_ball(world, board.ball_radius)
    paddles = board.collider_first + Part.FIRST_PADDLE
    for slot in range(MAX_BALLS):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        depth = max(depth, depth_in_borders(board, colliders, ball.x, ball.z))
        depth = max(depth, depth_in_stationary(board, colliders, ball.x, ball.z))
        for index in range(board.paddles):
            angle = world.paddle[index].angle
            inside = depth_in_paddle(colliders[paddles + index], angle, ball.x, ball.z, board.ball_radius)
            depth = max(depth, inside)
    return depth


@kernel
def angle_after(c: ColliderRecord, start: float, end: float, time: float) -> float:
    """Compute a paddle's angle `time` [s] after `start` [rad] on its way to `end` [rad], where it stays."""
    if end > start:
        return min(start + c.lift_speed * time, end)
    return max(start - c.return_speed * time, end)
