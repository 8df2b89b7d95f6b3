"""Contacts with one-way parts: capsules that let balls pass in one direction and block them in the other.

Let w be the height of a ball's centre over the axis of the capsule, in the direction in which balls pass,
and R the sum of the two radii. Blocked is the upper half of the outline around the capsule: the face w = R
between the ends, and a quarter of a circle of radius R around each end, down to w = 0.

A contact is a crossing of this outline *inwards*. A ball that comes from below crosses the axis, which is not
part of the outline, and leaves through the outline outwards: it meets nothing. If it falls back before it has
left, it meets nothing either; if it falls back afterwards, in the same flight or later, it is blocked. This
needs no state.

The ages of all contacts are computed from the start of the flight, as in `crossing.py`.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.crossing import disc_entries, falling_time, path_from
from silverball.physics.flight import newton_refined, state_at, stays_open, time_to_line
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import BallRecord, ColliderRecord
from silverball.physics.shapes import point_distance
from silverball.physics.tolerances import CONTACT_GAP, CROSSED_GAP, NEVER


@kernel
def time_to_one_way(
    c: ColliderRecord, ball: BallRecord, radius: float, start: float, limit: float
) -> tuple[float, bool]:
    """Find when a ball first meets a one-way capsule, from the age `start` on and before `limit`.

    Args:
        c: The capsule, from corner 0 to corner 1; `inward` is the unit direction in which balls pass.
        ball: The ball.
        radius: Its radius [u].
        start: The age at which the search starts [s].
        limit: The age at which the search ends [s].

    Returns:
        The age and True; or the limit and False.
    """
    reach = c.radius + radius
    now = state_at(ball, start)
    height = (now.x - c.x0) * c.inward_x + (now.z - c.z0) * c.inward_z
    rate = now.vx * c.inward_x + now.vz * c.inward_z
    height_accel = ball.accel_x * c.inward_x + ball.accel_z * c.inward_z
    above, below = height - reach - CROSSED_GAP, -height - CROSSED_GAP
    if above > 0.0 and stays_open(above, rate, height_accel, limit - start):
        return limit, False
    if below > 0.0 and stays_open(below, -rate, -height_accel, limit - start):
        return limit, False
    time = _time_to_face(c, ball, reach)
    time = time if start <= time < limit else limit
    time = _time_to_end(c, ball, reach, False, start, time)
    time = _time_to_end(c, ball, reach, True, start, time)
    return time, time < limit


@internal
def _time_to_face(c: ColliderRecord, ball: BallRecord, reach: float) -> float:
    """Compute the age at which a ball comes down on the face between the ends; NEVER if it does not."""
    gap = (ball.start_x - c.x0) * c.inward_x + (ball.start_z - c.z0) * c.inward_z - reach
    rate = ball.start_vx * c.inward_x + ball.start_vz * c.inward_z
    gap_accel = ball.accel_x * c.inward_x + ball.accel_z * c.inward_z
    if gap < -CROSSED_GAP:
        time = falling_time(gap, rate, gap_accel)
    else:
        time = time_to_line(max(gap, 0.0), rate, gap_accel)
    if not 0.0 <= time < NEVER:
        return NEVER
    foot = _foot(c, ball, time)
    return time if 0.0 <= foot <= c.length0 else NEVER


@internal
def _time_to_end(
    c: ColliderRecord, ball: BallRecord, reach: float, is_far: bool, start: float, limit: float
) -> float:
    """Compute the age at which a ball meets the quarter around corner 1 (`is_far`) or 0; or the limit."""
    x, z = (c.x1, c.z1) if is_far else (c.x0, c.z0)
    now = state_at(ball, start)
    gap, nx, nz = point_distance(now.x, now.z, x, z)
    gap -= reach + CROSSED_GAP
    rate, gap_accel = nx * now.vx + nz * now.vz, nx * ball.accel_x + nz * ball.accel_z
    if gap > 0.0 and stays_open(gap, rate, gap_accel, limit - start):
        return limit
    path = path_from(ball, x, z)
    first, second = disc_entries(path, reach, limit)
    apart = sqrt(path.x * path.x + path.z * path.z)
    gap = apart - reach
    if -CROSSED_GAP <= gap <= CONTACT_GAP:  # the flight starts on the outline
        approach = path.x * path.vx + path.z * path.vz
        if approach < 0.0:
            first = newton_refined(0.0, max(gap, 0.0), approach / apart)
        elif approach == 0.0 and path.x * path.accel_x + path.z * path.accel_z < 0.0:
            first = 0.0
    if start <= first < limit and _is_on_quarter(c, ball, is_far, first):
        return first
    if start <= second < limit and _is_on_quarter(c, ball, is_far, second):
        return second
    return limit


@inlined
def _foot(c: ColliderRecord, ball: BallRecord, age: float) -> float:
    """Compute how far along the axis from corner 0 a ball is at an age [u]."""
    at = state_at(ball, age)
    return (at.x - c.x0) * c.along_x0 + (at.z - c.z0) * c.along_z0


@inlined
def _is_on_quarter(c: ColliderRecord, ball: BallRecord, is_far: bool, age: float) -> bool:
    """Whether a ball is above the axis and beyond an end at an age, with a tolerance: no slit to the face."""
    at = state_at(ball, age)
    if (at.x - c.x0) * c.inward_x + (at.z - c.z0) * c.inward_z < 0.0:
        return False
    foot = _foot(c, ball, age)
    return foot >= c.length0 - CROSSED_GAP if is_far else foot <= CROSSED_GAP
