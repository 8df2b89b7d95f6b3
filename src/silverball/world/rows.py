"""Collider rows: what the physics reads of each primitive, by one function for each shape.

`set_row` writes the fields of shape, response, surface and motion. What a row has by its place on the board
(its part, its switch, its kind) is set in `compile.py`.

The points of a paddle are relative to its pivot: those of a left paddle at 0 rad, with the tip on the
positive z axis.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from silverball.physics.portable_math import sine_cosine
from silverball.physics.records import KickProfile, Shape
from silverball.table import Board
from silverball.table.primitive import Mover, Point, Primitive, Surface

SLACK = 1e-9  # [u] added to bounds, so that their rounding cannot matter
CIRCLE_SLACK = 1.0 + 1e-12  # factor on the radii of bounding circles, for the same reason
KICK_PROFILES = {"flat": KickProfile.FLAT, "parabola": KickProfile.PARABOLA}


def set_row(row: Any, primitive: Primitive, board: Board) -> None:
    """Write a primitive into a zeroed COLLIDER record; the board gives what its surface leaves open."""
    row["form"], row["response"] = primitive.shape, primitive.response
    row["levels"] = sum(1 << level for level in set(primitive.levels))
    SET_SHAPE[primitive.shape](row, primitive)
    if primitive.passage is not None:
        lengthen(row, board.ball_radius)
    set_surface(row, primitive.surface, board)
    if primitive.mover is not None:
        set_mover(row, primitive, primitive.mover)


def set_plane(row: Any, primitive: Primitive) -> None:
    """Write a border: its inward normal, and its coordinate along it."""
    (x, z), (nx, nz) = primitive.points
    row["inward_x"], row["inward_z"] = nx, nz
    if nx != 0.0:
        row["x"] = x
    if nz != 0.0:
        row["z"] = z


def set_circle(row: Any, primitive: Primitive) -> None:
    """Write a circle or a disc."""
    row["x"], row["z"] = primitive.points[0]
    row["radius"] = row["reach"] = primitive.radius


def set_capsule(row: Any, primitive: Primitive) -> None:
    """Write a capsule or a line. Its normal points to the board's centre.

    That of a one-way capsule points to the side from which it is met, that of a line to the left of start →
    end, as the player sees it.
    """
    start, end = primitive.points
    set_side(row, 0, start, end)
    row["x1"], row["z1"] = end
    row["radius"] = primitive.radius
    row["x"], row["z"] = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    row["reach"] = row["length0"] / 2 + primitive.radius
    nx, nz = row["along_z0"], 0.0 - row["along_x0"]
    if primitive.one_way is not None:
        row["one_way"] = 1
        is_towards = nx * primitive.one_way[0] + nz * primitive.one_way[1] > 0.0
    else:
        side = nx * (0.0 - start[0]) + nz * (0.0 - start[1])
        if abs(side) < 1e-12:  # [u] through the centre, but for rounding: up, or right if it is vertical
            side = nx if nx != 0.0 else nz
        is_towards = side > 0.0 or primitive.shape == Shape.LINE
    row["inward_x"], row["inward_z"] = (nx, nz) if is_towards else (0.0 - nx, 0.0 - nz)


def set_triangle(row: Any, primitive: Primitive) -> None:
    """Write a triangle with counter-clockwise corners, and a circle around its centroid."""
    corners = primitive.points
    for number in range(3):
        set_side(row, number, corners[number], corners[(number + 1) % 3])
    x, z = sum(corner[0] for corner in corners) / 3, sum(corner[1] for corner in corners) / 3
    farthest = max((corner[0] - x) ** 2 + (corner[1] - z) ** 2 for corner in corners)
    row["x"], row["z"], row["reach"] = x, z, math.sqrt(farthest) * CIRCLE_SLACK


def set_tapered(row: Any, primitive: Primitive) -> None:
    """Write a tapered capsule from the origin to its tip on the z axis.

    Raises:
        ValueError: The tip lies within the base's circle, or the tip's radius is larger than the base's.
    """
    base, tip = primitive.points
    set_side(row, 0, base, tip)
    row["x1"], row["z1"] = tip
    row["radius"], row["tip_radius"] = primitive.radius, primitive.tip_radius
    sine = (primitive.radius - primitive.tip_radius) / row["length0"]
    if not 0.0 <= sine < 1.0:
        raise ValueError(
            "a tapered capsule must be longer than the difference of its radii, and not be thicker at its "
            f"tip, got the length {row['length0']} and the radii {primitive.radius}, {primitive.tip_radius}"
        )
    row["taper_sine"], row["taper_cosine"] = sine, math.sqrt((1.0 - sine) * (1.0 + sine))


def set_arc(row: Any, primitive: Primitive) -> None:
    """Write an arc: its ends with the tangents there, its circle, and the direction of its middle."""
    arc = primitive.arc
    row["x2"], row["z2"] = arc.center
    row["inward_x"], row["inward_z"] = arc.middle
    row["arc_radius"], row["radius"] = arc.radius, primitive.radius
    row["arc_is_major"] = abs(primitive.bulge) > 1.0
    for number, end in enumerate(primitive.points):
        row[f"x{number}"], row[f"z{number}"] = end
        ex, ez = end[0] - arc.center[0], end[1] - arc.center[1]
        length = math.copysign(math.sqrt(ex * ex + ez * ez), ez * arc.middle[0] - ex * arc.middle[1])
        row[f"along_x{number}"], row[f"along_z{number}"] = ez / length, 0.0 - ex / length
    (x0, z0), (x1, z1) = primitive.points
    if row["arc_is_major"]:
        (row["x"], row["z"]), reach = arc.center, arc.radius
    else:  # the circle over the chord
        row["x"], row["z"] = (x0 + x1) / 2, (z0 + z1) / 2
        reach = 0.5 * math.sqrt((x1 - x0) ** 2 + (z1 - z0) ** 2)
    row["reach"] = (reach + primitive.radius) * CIRCLE_SLACK


SET_SHAPE: dict[Shape, Callable[[Any, Primitive], None]] = {
    Shape.PLANE: set_plane,
    Shape.CIRCLE: set_circle,
    Shape.CAPSULE: set_capsule,
    Shape.TRIANGLE: set_triangle,
    Shape.TAPERED: set_tapered,
    Shape.ARC: set_arc,
    Shape.LINE: set_capsule,
    Shape.DISC: set_circle,
}


def set_side(row: Any, number: int, start: Point, end: Point) -> None:
    """Write a side from a corner to the next: the corner, the unit direction, the length."""
    dx, dz = end[0] - start[0], end[1] - start[1]
    length = math.sqrt(dx * dx + dz * dz)  # not hypot, whose last bit differs between systems
    row[f"x{number}"], row[f"z{number}"] = start
    row[f"along_x{number}"], row[f"along_z{number}"] = dx / length, dz / length
    row[f"length{number}"] = length


def lengthen(row: Any, by: float) -> None:
    """Lengthen a line at both ends [u].

    Between two rails the line of a passage ends where a ball that rolls along a rail has its centre, or a
    little before. The ball must not miss it.
    """
    row["x0"] -= by * row["along_x0"]
    row["z0"] -= by * row["along_z0"]
    row["x1"] += by * row["along_x0"]
    row["z1"] += by * row["along_z0"]
    row["length0"] += 2.0 * by
    row["reach"] += by


def set_surface(row: Any, surface: Surface, board: Board) -> None:
    """Write how a contact acts on a ball."""
    row["restitution"], row["restitution_falloff"] = surface.restitution, surface.restitution_falloff
    row["speed_factor"], row["points"] = surface.speed_factor, surface.points
    row["friction"] = board.friction if surface.friction is None else surface.friction
    row["hit_speed"] = board.hit_speed if surface.hit_speed is None else surface.hit_speed
    row["kick"] = surface.kick
    if row["form"] in (Shape.CAPSULE, Shape.ARC):  # the other shapes have no ends
        row["kick_profile"] = KICK_PROFILES[surface.kick_profile]


def set_mover(row: Any, primitive: Primitive, mover: Mover) -> None:
    """Write how a paddle moves. It is at its pivot, and its shape is in its own frame."""
    row["side"] = mover.direction
    row["x"], row["z"] = mover.pivot
    row["reach"] = max(radius + math.sqrt(x * x + z * z) for x, z, radius in _outline(primitive))
    row["angle_rest"], row["angle_up"] = mover.rest_angle, mover.up_angle
    for name in ("rest", "up"):
        row[f"sine_{name}"], row[f"cosine_{name}"] = sine_cosine(row[f"angle_{name}"])
    swing = mover.up_angle - mover.rest_angle
    for name, stroke in (("lift", mover.stroke), ("return", mover.return_stroke)):
        row[f"{name}_speed"] = swing / stroke
        if mover.is_coil:  # from standstill it turns by ½·α·t²; the speed is that at the end
            row[f"{name}_speed"], row[f"{name}_accel"] = 2.0 * swing / stroke, 2.0 * swing / stroke**2
    if mover.mass is not None:
        length = primitive.points[1][1]  # from the pivot to the tip
        row["recoil"] = 3.0 / (mover.mass * length**2)


def swept_circle(primitive: Primitive, mover: Mover) -> tuple[float, float, float]:
    """Compute a circle (x, z, radius) [u] around a paddle at all its angles.

    The centre lies halfway to the tip at the middle angle; the farthest points are the tip at either stop and
    the base.
    """
    length, base_radius, tip_radius = _extent(primitive)
    middle, swing = 0.5 * (mover.rest_angle + mover.up_angle), 0.5 * (mover.up_angle - mover.rest_angle)
    half = 0.5 * length
    x, z = half * math.sin(middle), mover.direction * half * math.cos(middle)
    tip = math.sqrt(length**2 + half**2 - 2 * length * half * math.cos(swing)) + tip_radius
    return mover.pivot[0] + x, mover.pivot[1] + z, max(tip, half + base_radius) + SLACK


def highest_x(primitive: Primitive, mover: Mover) -> float:
    """Bound the x [u] that any point of a paddle reaches at any of its angles."""
    length, base_radius, tip_radius = _extent(primitive)
    is_upright_between = mover.rest_angle <= math.pi / 2 <= mover.up_angle
    sine = 1.0 if is_upright_between else max(math.sin(mover.rest_angle), math.sin(mover.up_angle))
    return mover.pivot[0] + max(length * sine + tip_radius, base_radius) + SLACK


def _extent(primitive: Primitive) -> tuple[float, float, float]:
    """The distance of a paddle's tip from its pivot, and the radii around the base and the tip."""
    tip_radius = primitive.tip_radius if primitive.shape == Shape.TAPERED else 0.0
    outline = _outline(primitive)
    base_radius = max(radius + abs(x) for x, z, radius in outline if z <= 0.0)
    return primitive.points[1][1], base_radius, tip_radius


def _outline(primitive: Primitive) -> Sequence[tuple[float, float, float]]:
    """Circles (x, z, radius) whose convex hull is a paddle, relative to its pivot."""
    if primitive.shape == Shape.TAPERED:
        (x0, z0), (x1, z1) = primitive.points
        return (x0, z0, primitive.radius), (x1, z1, primitive.tip_radius)
    return tuple((x, z, 0.0) for x, z in primitive.points)
