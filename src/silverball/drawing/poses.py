"""The pose of each moving part at a moment of play."""

from __future__ import annotations

import math

from silverball.drawing.effects import Effects
from silverball.drawing.moment import Moment
from silverball.drawing.moving import Motion, MovingPart, nearest_pose, spinning_pose, turning_pose

BULGE_SECONDS = 0.1  # that the rubber of a slingshot bulges after a kick
SWING_SECONDS = 0.35  # after which the flap of a gate hangs still again
BLADE_AT_REST = 0.0  # [rad]


def pose_of(part: MovingPart, moment: Moment, effects: Effects) -> int | None:
    """Return the pose of a part; None if nothing of it is to be drawn over the table."""
    if part.motion is Motion.TURNING:
        return turning_pose(part, moment.angles[part.number]) if part.number < len(moment.angles) else None
    if part.motion is Motion.SPINNING:
        angles = moment.blades
        return spinning_pose(angles[part.number] if part.number < len(angles) else BLADE_AT_REST)
    if part.motion is Motion.PULLED:
        return nearest_pose(part, moment.charge)
    if part.motion is Motion.STANDING:
        return None if is_off(part, moment) else 0
    if part.motion is Motion.HANGING:
        if part.switch is not None and is_off(part, moment):
            return part.poses - 1
        age = effects.age(part.part, moment.time)
        if age is None or age > SWING_SECONDS:
            return 0
        return nearest_pose(
            part, abs(math.cos(1.5 * math.pi * age / SWING_SECONDS)) * (1.0 - age / SWING_SECONDS)
        )
    kick = effects.kick(part.part, moment.time)
    if kick is None or kick.age > BULGE_SECONDS:
        return None
    return 0 if _is_on_right(part, kick.x, kick.z) else 1


def is_off(part: MovingPart, moment: Moment) -> bool:
    """Return whether the switch of a drop target or gate is off: it has fallen, or is open."""
    return part.switch is not None and moment.off >> part.switch & 1 == 1


def _is_on_right(part: MovingPart, x: float, z: float) -> bool:
    """Return whether a place is to the right of start → end, as the player sees it."""
    (x0, z0), (x1, z1) = part.primitive.points
    return (x1 - x0) * (z - z0) - (z1 - z0) * (x - x0) > 0.0
