"""Is a ball inside anything? A second opinion that shares no code with the solver.

The solver trusts `shapes.py`; this check does not. It takes a part's corners alone, turns a paddle's with
the library's sine, finds the nearest point of each side by clamping the foot, and tells inside from outside
by the signs of three cross products. It is slow, and runs only where somebody asks for it: in tests, soaks
and `silverball simulate`.
"""

from __future__ import annotations

from math import cos, hypot, inf, sin
from typing import Any

from silverball.physics.kernel import kernel
from silverball.physics.layout import BALL_COUNT, Kind, Part


@kernel
def side_gap(x: float, z: float, px: float, pz: float, qx: float, qz: float) -> float:
    """Distance of (x, z) from the segment p → q: the foot's share of the way is clamped to 0 … 1."""
    wx, wz = qx - px, qz - pz
    share = ((x - px) * wx + (z - pz) * wz) / (wx * wx + wz * wz)
    share = min(1.0, max(0.0, share))
    return hypot(x - (px + share * wx), z - (pz + share * wz))


@kernel
def is_right_of(x: float, z: float, px: float, pz: float, qx: float, qz: float) -> bool:
    """Whether (x, z) lies to the right of the way p → q, as the player sees it."""
    return (qz - pz) * (x - px) - (qx - px) * (z - pz) < 0.0


@kernel
def corners_gap(
    x: float, z: float, px: float, pz: float, qx: float, qz: float, rx: float, rz: float
) -> float:
    """Distance of (x, z) from the triangle p q r (counter-clockwise), negative inside."""
    near = min(side_gap(x, z, px, pz, qx, qz), side_gap(x, z, qx, qz, rx, rz), side_gap(x, z, rx, rz, px, pz))
    outside = (
        is_right_of(x, z, px, pz, qx, qz)
        or is_right_of(x, z, qx, qz, rx, rz)
        or is_right_of(x, z, rx, rz, px, pz)
    )
    return near if outside else -near


@kernel
def part_gap(c: Any, angle: float, x: float, z: float) -> float:
    """Distance of (x, z) from a part, a paddle standing at `angle` [rad]; infinite for a border."""
    if c.kind == Kind.CYLINDER:
        return hypot(x - c.x, z - c.z) - c.radius
    if c.kind == Kind.SLANT_WALL:
        return side_gap(x, z, c.x0, c.z0, c.x1, c.z1) - c.radius
    if c.kind == Kind.TRIANGULAR_PRISM:
        return corners_gap(x, z, c.x0, c.z0, c.x1, c.z1, c.x2, c.z2)
    if c.kind != Kind.PADDLE:
        return inf
    # Turn the ball the other way round instead of the three corners; the right paddle is seen in the mirror.
    s, k = sin(-angle), cos(-angle)
    dx, dz = x - c.x, (z - c.z) * c.side
    return corners_gap(k * dx + s * dz, k * dz - s * dx, c.x0, c.z0, c.x1, c.z1, c.x2, c.z2)


@kernel
def deepest(world: Any, board: Any, colliders: Any) -> float:
    """How deep any ball is inside any part, border or other ball [u]; 0 if none is."""
    depth = 0.0
    first, radius = board.collider_first, board.ball_radius
    for slot in range(BALL_COUNT):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        x, z = ball.x, ball.z
        depth = max(depth, colliders[first + Part.LEFT_WALL].z - (z - radius))
        depth = max(depth, (z + radius) - colliders[first + Part.RIGHT_WALL].z)
        depth = max(depth, (x + radius) - colliders[first + Part.TOP_WALL].x)
        for index in range(first + Part.LEFT_PADDLE, board.collider_end):
            side = 1 if index - first == Part.RIGHT_PADDLE else 0
            depth = max(depth, radius - part_gap(colliders[index], world.paddle[side].angle, x, z))
    a, b = world.ball[0], world.ball[1]
    if a.id != 0 and b.id != 0:
        depth = max(depth, 2.0 * radius - hypot(a.x - b.x, a.z - b.z))
    return depth
