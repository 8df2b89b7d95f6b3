"""The pose of each moving part at a moment of play."""

from __future__ import annotations

import math

from silverball.drawing.effects import Effects
from silverball.drawing.moment import Moment
from silverball.drawing.moving import Motion, MovingPart, nearest_pose, spinning_pose, turning_pose

OPENED = 0.6  # radii of a ball that it is beyond the flap when this is open
BULGE_SECONDS = 0.1  # that the rubber of a slingshot bulges after a kick


def pose_of(part: MovingPart, moment: Moment, effects: Effects, radius: float) -> int | None:
    """Return the pose of a part; None if nothing of it is to be drawn over the table.

    Args:
        part: The part.
        moment: The state of play.
        effects: The recent hits, for slingshots.
        radius: Of a ball [u], for the flaps that it lifts.
    """
    if part.motion is Motion.TURNING:
        return turning_pose(part, moment.angles[part.number]) if part.number < len(moment.angles) else None
    if part.motion is Motion.SPINNING:
        return spinning_pose(_blade_angle(part, moment))
    if part.motion is Motion.PULLED:
        assert part.primitive.launch is not None
        return nearest_pose(part, moment.launch_held / part.primitive.launch.charge)
    if part.motion is Motion.STANDING:
        return None if is_off(part, moment) else 0
    if part.motion is Motion.HANGING:
        return part.poses - 1 if is_off(part, moment) else nearest_pose(part, _opening(part, moment, radius))
    kick = effects.kick(part.part, moment.time)
    if kick is None or moment.time - kick.time > BULGE_SECONDS:
        return None
    return 0 if _is_on_right(part, kick.x, kick.z) else 1


def is_off(part: MovingPart, moment: Moment) -> bool:
    """Return whether the switch of a drop target or gate is off: it has fallen, or is open."""
    return part.switch is not None and moment.off >> part.switch & 1 == 1


def _blade_angle(part: MovingPart, moment: Moment) -> float:
    """Return the angle of a blade [rad], as in physics/spinner.py."""
    assert part.primitive.spin is not None
    if part.number >= len(moment.blades):
        return 0.0
    angle, speed, time = moment.blades[part.number]
    damping, elapsed = part.primitive.spin.damping, max(moment.time - time, 0.0)
    return angle + speed * (-math.expm1(-damping * elapsed) / damping if damping > 0.0 else elapsed)


def _opening(part: MovingPart, moment: Moment, radius: float) -> float:
    """Return how far balls on their way through a gate lift its flap, 0 to 1."""
    (x0, z0), (x1, z1) = part.primitive.points
    length = math.dist((x0, z0), (x1, z1))
    along_x, along_z = (x1 - x0) / length, (z1 - z0) / length
    opening = 0.0
    for ball in moment.balls:
        dx, dz = ball.x - x0, ball.z - z0
        if ball.level in part.primitive.levels and 0.0 < dx * along_x + dz * along_z < length:
            opening = max(opening, (radius - abs(dx * along_z - dz * along_x)) / (OPENED * radius))
    return min(opening, 1.0)


def _is_on_right(part: MovingPart, x: float, z: float) -> bool:
    """Return whether a place is to the right of start → end, as the player sees it."""
    (x0, z0), (x1, z1) = part.primitive.points
    return (x1 - x0) * (z - z0) - (z1 - z0) * (x - x0) > 0.0
