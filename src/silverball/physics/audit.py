"""Audit: how deep a ball is inside a part, computed without any code of the solver.

The solver trusts `shapes.py`; this check does not. It uses a part's corners alone, turns a paddle's with
the C library's sine, finds the nearest point of each side by clamping the foot, and tells inside from outside
by the signs of three cross products. An arc is measured by angles, a tapered capsule as a row of circles, and
the inside of a closed wall is found by counting the edges on one side. Lines and discs, which only the
ball's centre meets, and one-way parts, in which a passing ball may be, have no depth. A part whose bounding
box is further away than a ball's radius is culled. It runs only in tests, soaks and `silverball simulate`.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, sin, sqrt

from silverball.physics.for_devices import level_of, switches_off
from silverball.physics.kernel import inlined, kernel
from silverball.physics.records import (
    BoardRecord,
    ColliderRecord,
    Colliders,
    Motion,
    Part,
    Response,
    Shape,
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
def arc_gap(c: ColliderRecord, x: float, z: float) -> float:
    """Compute the distance of (x, z) from an arc, by its angle from the arc's middle at the centre."""
    start_x, start_z, dx, dz = c.x0 - c.x2, c.z0 - c.z2, x - c.x2, z - c.z2
    half = atan2(
        abs(start_x * c.inward_z - start_z * c.inward_x), start_x * c.inward_x + start_z * c.inward_z
    )
    turn = atan2(abs(dx * c.inward_z - dz * c.inward_x), dx * c.inward_x + dz * c.inward_z)
    if turn <= half:
        return abs(hypot(dx, dz) - hypot(start_x, start_z)) - c.radius
    return min(hypot(x - c.x0, z - c.z0), hypot(x - c.x1, z - c.z1)) - c.radius


@kernel
def tapered_gap(c: ColliderRecord, x: float, z: float) -> float:
    """Compute the distance of (x, z) from a tapered capsule in its own frame.

    It is a row of circles, whose radius falls evenly from the base to the tip, by s = (r₀ − r₁)/L. The one
    whose surface is nearest has its centre at z − |x|·s/√(1 − s²).
    """
    fall = (c.radius - c.tip_radius) / c.z1
    center = min(max(z - abs(x) * fall / sqrt(1.0 - fall * fall), 0.0), c.z1)
    return hypot(x, z - center) - (c.radius - fall * center)


@inlined
def is_paddle(c: ColliderRecord) -> bool:
    """Whether a row is a paddle; there may be rows of paddles that the table does not have."""
    return c.side != 0.0 and c.form in (Shape.TRIANGLE, Shape.TAPERED)


@kernel
def part_gap(c: ColliderRecord, angle: float, x: float, z: float) -> float:
    """Compute the distance of (x, z) from a part, a paddle at `angle` [rad].

    It is infinite for a border, and for lines and discs.
    """
    if c.form == Shape.CIRCLE:
        return hypot(x - c.x, z - c.z) - c.radius
    if c.form == Shape.CAPSULE:
        return side_gap(x, z, c.x0, c.z0, c.x1, c.z1) - c.radius
    if c.form == Shape.ARC:
        return arc_gap(c, x, z)
    if is_paddle(c):
        # Rotate the ball backwards instead of the paddle; the right paddle is mirrored.
        sine, cosine = sin(-angle), cos(-angle)
        dx, dz = x - c.x, (z - c.z) * c.side
        x, z = cosine * dx + sine * dz, cosine * dz - sine * dx
    if c.form == Shape.TAPERED:
        return tapered_gap(c, x, z)
    if c.form == Shape.TRIANGLE:
        return corners_gap(x, z, c.x0, c.z0, c.x1, c.z1, c.x2, c.z2)
    return inf


@inlined
def is_met(c: ColliderRecord, level: int, off: int) -> bool:
    """Whether a ball on a level may not be inside a row, with the bits of the switches that are off."""
    return (
        c.levels >> level & 1 != 0
        and c.switch & off == 0
        and c.response == Response.BOUNCE
        and c.one_way == 0
    )


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
    if c.form in (Shape.LINE, Shape.DISC):
        return inf, -inf, inf, -inf
    if c.form == Shape.CIRCLE:
        return c.x - c.radius, c.x + c.radius, c.z - c.radius, c.z + c.radius
    if c.form == Shape.ARC:  # the whole circle, or, if it is less than half of it, the one over the chord
        x, z, reach = c.x2, c.z2, hypot(c.x0 - c.x2, c.z0 - c.z2) + c.radius
        if (c.x0 - c.x2) * c.inward_x + (c.z0 - c.z2) * c.inward_z > 0.0:
            x, z = 0.5 * (c.x0 + c.x1), 0.5 * (c.z0 + c.z1)
            reach = 0.5 * hypot(c.x0 - c.x1, c.z0 - c.z1) + c.radius
        return x - reach, x + reach, z - reach, z + reach
    low_x, high_x = min(c.x0, c.x1), max(c.x0, c.x1)
    low_z, high_z = min(c.z0, c.z1), max(c.z0, c.z1)
    if c.form == Shape.CAPSULE:
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
    if not is_paddle(c):
        return True
    if c.form == Shape.TAPERED:
        reach = max(c.radius, c.z1 + c.tip_radius) + radius
    else:
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
def depth_in_stationary(
    board: BoardRecord, colliders: Colliders, x: float, z: float, level: int = 0, off: int = 0
) -> float:
    """Compute how deep a ball at (x, z) is inside a stationary part [u]; 0 if it is not.

    Args:
        board: A BOARD record.
        colliders: COLLIDER records of all boards.
        x: Of the ball's centre [u].
        z: Of the ball's centre [u].
        level: The ball's level; other levels' parts are ignored.
        off: The bits of the switches that are off; parts behind them are ignored.
    """
    depth, radius = 0.0, board.ball_radius
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        c = colliders[index]
        if is_met(c, level, off) and not is_outside_box(c, x, z, radius):
            depth = max(depth, radius - part_gap(c, 0.0, x, z))
    return depth


@kernel
def chain_end(colliders: Colliders, first: int, end: int) -> int:
    """Find where the chain that starts at the row `first` ends: its edges are joined, and of one part.

    Returns:
        One past the last row of the chain; `first` itself where none starts.
    """
    row = first
    while row < end:
        c = colliders[row]
        if c.form not in (Shape.CAPSULE, Shape.ARC):
            break
        if row > first:
            last = colliders[row - 1]
            if c.part != last.part or c.x0 != last.x1 or c.z0 != last.z1:
                break
        row += 1
    return row


@kernel
def is_inside_chain(colliders: Colliders, first: int, end: int, x: float, z: float) -> bool:
    """Whether a closed chain of rows goes round (x, z).

    The polygon of the edges' chords contains it if an odd number of them lies to its right. Each circular
    segment between a chord and its arc that contains it reverses that.
    """
    is_inside = False
    for row in range(first, end):
        c = colliders[row]
        if (c.x0 > x) != (c.x1 > x) and z < c.z0 + (x - c.x0) / (c.x1 - c.x0) * (c.z1 - c.z0):
            is_inside = not is_inside
        if (
            c.form == Shape.ARC
            and (x - c.x0) * c.inward_x + (z - c.z0) * c.inward_z > 0.0
            and hypot(x - c.x2, z - c.z2) < hypot(c.x0 - c.x2, c.z0 - c.z2)
        ):
            is_inside = not is_inside
    return is_inside


@kernel
def is_in_solid(
    board: BoardRecord, colliders: Colliders, x: float, z: float, level: int = 0, off: int = 0
) -> bool:
    """Whether (x, z) is inside a closed wall, behind its edges; the arguments of `depth_in_stationary`."""
    row = board.collider_first + board.shape_first
    while row < board.collider_end:
        end = chain_end(colliders, row, board.collider_end)
        if end > row + 1:
            first, last = colliders[row], colliders[end - 1]
            if (
                first.x0 == last.x1
                and first.z0 == last.z1
                and is_met(first, level, off)
                and is_inside_chain(colliders, row, end, x, z)
            ):
                return True
        row = max(end, row + 1)
    return False


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
    for other in range(1, len(world.ball)):
        for one in range(other):
            a, b = world.ball[one], world.ball[other]
            if a.id != 0 and b.id != 0 and level_of(a) == level_of(b):
                depth = max(depth, 2.0 * radius - hypot(a.x - b.x, a.z - b.z))
    return depth


@kernel
def deepest(world: WorldRecord, board: BoardRecord, colliders: Colliders) -> float:
    """Compute how deep any ball is inside any part, border or other ball [u]; 0 if none is."""
    depth, off = depth_in_other_ball(world, board.ball_radius), switches_off(world)
    paddles = board.collider_first + Part.FIRST_PADDLE
    for slot in range(len(world.ball)):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        depth = max(depth, depth_in_borders(board, colliders, ball.x, ball.z))
        if ball.motion == Motion.CAPTURED:  # it lies in a hole, below everything but other balls
            continue
        depth = max(depth, depth_in_stationary(board, colliders, ball.x, ball.z, level_of(ball), off))
        if is_in_solid(board, colliders, ball.x, ball.z, level_of(ball), off):
            depth = max(depth, board.ball_radius)
        for index in range(board.paddles):
            if not is_met(colliders[paddles + index], level_of(ball), off):
                continue
            angle = world.paddle[index].angle
            inside = depth_in_paddle(colliders[paddles + index], angle, ball.x, ball.z, board.ball_radius)
            depth = max(depth, inside)
    return depth


@kernel
def angle_after(c: ColliderRecord, start: float, end: float, time: float, omega: float = 0.0) -> float:
    """Compute a paddle's angle `time` [s] after `start` [rad] on its way to `end` [rad], where it stays.

    `omega` is its angular velocity at the start [rad/s]; it matters only if a coil drives the paddle.
    """
    if end > start:
        way = c.lift_speed * time
        if c.lift_accel != 0.0:
            way = time * (max(omega, 0.0) + 0.5 * c.lift_accel * time)
        return min(start + way, end)
    way = c.return_speed * time
    if c.return_accel != 0.0:
        way = time * (max(-omega, 0.0) + 0.5 * c.return_accel * time)
    return max(start - way, end)
