"""What moves on a table: for each moving primitive a few poses, each of which is baked as one sprite.

    turning   paddles             from rest to up, a degree at a time
    standing  drop targets        one pose; none while it is down
    hanging   gates               a flap that swings up
    spinning  spinners            a blade at angles of half a turn
    pulled    plungers            from released to fully charged
    kicking   slingshots          the rubber bulges to the one or the other side

Poses are numbered from 0. `Layout.without(is_moving)` is the table that does not move; a slingshot and a
plunger are part of both.
"""

from __future__ import annotations

import math
from enum import Enum
from typing import NamedTuple

from silverball.drawing.layout import Layout
from silverball.physics.forms import Shape
from silverball.table.primitive import Finish, Mover, Point, Primitive

DEGREES = 1.0  # about, between two poses of a paddle
SPIN_POSES = 12  # of half a turn
FLAP_POSES = 5
FLAP_ANGLE = math.radians(72.0)  # of a gate that is wide open
PULL_POSES = 9
PULL = 0.9  # [u] that a charged plunger is pulled back


class Motion(Enum):
    """How a primitive moves."""

    TURNING = "turning"
    STANDING = "standing"
    HANGING = "hanging"
    SPINNING = "spinning"
    PULLED = "pulled"
    KICKING = "kicking"


class MovingPart(NamedTuple):
    """A primitive that moves.

    Attributes:
        part: The part that it belongs to, by its path.
        primitive: The primitive.
        motion: How it moves.
        number: Its number among those that move alike; that of a paddle counts the angles of a `Moment`.
        poses: The number of its poses.
        switch: The bit of its switch in a `Moment`; None if it is always there.
    """

    part: str
    primitive: Primitive
    motion: Motion
    number: int
    poses: int
    switch: int | None = None

    @property
    def level(self) -> int:
        """The level on which it is drawn."""
        return max(self.primitive.levels)


def motion_of(primitive: Primitive) -> Motion | None:
    """Return how a primitive moves; None if it does not."""
    if primitive.mover is not None:
        return Motion.TURNING
    if primitive.spin is not None:
        return Motion.SPINNING
    if primitive.launch is not None:
        return Motion.PULLED
    if primitive.is_gate or primitive.one_way is not None:
        return Motion.HANGING
    if primitive.bank is not None:
        return Motion.STANDING
    if (
        primitive.surface.kick > 0.0
        and primitive.shape == Shape.CAPSULE
        and primitive.finish is Finish.RUBBER
    ):
        return Motion.KICKING
    return None


def moving_parts(layout: Layout) -> tuple[MovingPart, ...]:
    """Return the moving primitives of a layout, in the order of its rows."""
    found: list[MovingPart] = []
    switches = 0
    for part, primitive in layout.rows:
        motion = motion_of(primitive)
        if motion is not None:
            number = sum(other.motion is motion for other in found)
            switch = None
            if primitive.has_switch:
                switch, switches = switches, switches + 1
            found.append(MovingPart(part, primitive, motion, number, _pose_count(primitive, motion), switch))
    return tuple(found)


def is_moving(primitive: Primitive) -> bool:
    """Return whether a primitive is absent from the picture of the table without moving parts."""
    return motion_of(primitive) not in (None, Motion.KICKING)


def _pose_count(primitive: Primitive, motion: Motion) -> int:
    if primitive.mover is not None:
        swing = math.degrees(primitive.mover.up_angle - primitive.mover.rest_angle)
        return max(math.ceil(round(swing, 6) / DEGREES), 1) + 1
    counts = {
        Motion.STANDING: 1,
        Motion.HANGING: FLAP_POSES,
        Motion.SPINNING: SPIN_POSES,
        Motion.PULLED: PULL_POSES,
        Motion.KICKING: 2,
    }
    return counts[motion]


def turning_pose(part: MovingPart, angle: float) -> int:
    """Return the pose of a paddle nearest to an angle [deg]."""
    assert part.primitive.mover is not None
    rest, up = _stops(part.primitive.mover)
    return min(max(round((angle - rest) / (up - rest) * (part.poses - 1)), 0), part.poses - 1)


def pose_angle(part: MovingPart, pose: int) -> float:
    """Return the angle [deg] of a paddle's pose; the first and the last are exactly the stops."""
    assert part.primitive.mover is not None
    rest, up = _stops(part.primitive.mover)
    return up if pose == part.poses - 1 else rest + pose * (up - rest) / (part.poses - 1)


def _stops(mover: Mover) -> tuple[float, float]:
    """Return the angles of rest and up [deg], without the rounding of the conversion to radians."""
    return round(math.degrees(mover.rest_angle), 9), round(math.degrees(mover.up_angle), 9)


def nearest_pose(part: MovingPart, share: float) -> int:
    """Return the pose at a share, 0 to 1, of a flap's way up or of a plunger's way back."""
    return min(max(round(share * (part.poses - 1)), 0), part.poses - 1)


def spinning_pose(angle: float) -> int:
    """Return the pose of a blade at an angle [rad]; half a turn looks like none."""
    return round(angle / math.pi * SPIN_POSES) % SPIN_POSES


def coarse_to_fine(poses: int) -> list[int]:
    """Return the poses from coarse to fine: the first and the last, the middle, the quarters, and so on."""
    order = dict.fromkeys((0, poses - 1))
    stride = poses - 1
    while stride > 1:
        stride = (stride + 1) // 2
        order.update(dict.fromkeys(range(0, poses - 1, stride)))
    return list(order)


def mirrored(primitive: Primitive) -> Primitive | None:
    """Return the mirror image of a paddle, as far as it can be seen; None for anything else."""
    mover = primitive.mover
    if mover is None:
        return None
    x, z = mover.pivot
    image = mover._replace(pivot=(x, -z), direction=-mover.direction)
    return visible(primitive._replace(mover=image))


def visible(primitive: Primitive) -> Primitive:
    """Return a primitive without what cannot be seen of it."""
    mover = primitive.mover
    if mover is not None:
        mover = mover._replace(stroke=0.0, return_stroke=0.0, button="", is_coil=False, mass=None)
    kick = 1.0 if primitive.surface.kick > 0.0 else 0.0
    return primitive._replace(mover=mover, surface=type(primitive.surface)(kick=kick))


def turned(primitive: Primitive, angle: float) -> list[Point]:
    """Return the points of a paddle at an angle [deg], counter-clockwise."""
    mover = primitive.mover
    assert mover is not None
    sine, cosine = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    x, z = mover.pivot
    points = [
        (x + (across * cosine + along * sine), z + mover.direction * (along * cosine - across * sine))
        for across, along in primitive.points
    ]
    return points if mover.direction > 0.0 else points[::-1]
