"""When does a ball in flight touch something for the first time?

Between contacts a ball flies on a parabola. Let D be the gap between ball and shape, n the unit normal at
the nearest point, D′ = n·v its rate and α = n·a. A convex shape lies wholly behind the line through its
nearest point at right angles to n, so the ball cannot touch it before it has used up the gap to that line:

    D + D′·h + ½·α·h² = 0,   h the smallest root ≥ 0.

Fly h, look again, until the gap is gone; one Newton step removes what is left. A flat face is met by the
first step, corners and circles after a few: near the contact the step is Newton's, and it always stays on
the safe side.

Source: the idea is that of conservative advancement (B. Mirtich, "Impulse-based Dynamic Simulation of Rigid
Body Systems", 1996, ch. 2), with the exact parabola in place of a bound on the speed.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.kernel import inlined, kernel
from silverball.physics.layout import NOTHING, OTHER_BALL, PAUSE, Ball, Contact
from silverball.physics.shapes import distance
from silverball.physics.tolerances import CONTACT_GAP, FLIGHT_STEPS, NEVER, POLISH_TIME


@inlined
def time_to_line(gap: float, rate: float, bend: float) -> float:
    """The smallest h ≥ 0 [s] with  gap + rate·h + ½·bend·h² = 0,  for gap ≥ 0; NEVER if there is none.

    Of the two forms of the root, the one without cancellation:
    (−rate ∓ √Δ)/bend = 2·gap/(√Δ − rate)  with  Δ = rate² − 2·bend·gap.
    """
    square = rate * rate - 2.0 * bend * gap
    if rate < 0.0:
        return NEVER if square < 0.0 else 2.0 * gap / (sqrt(square) - rate)
    return (rate + sqrt(square)) / -bend if bend < 0.0 else NEVER


@inlined
def flown(ball: Ball, pull_x: float, pull_z: float, h: float) -> Ball:
    """The ball after h seconds of free flight:  p + v·h + ½·a·h²,  v + a·h."""
    return Ball(
        ball.x + h * (ball.vx + 0.5 * pull_x * h),
        ball.z + h * (ball.vz + 0.5 * pull_z * h),
        ball.vx + pull_x * h,
        ball.vz + pull_z * h,
        ball.id,
    )


@inlined
def polished(time: float, gap: float, rate: float) -> float:
    """The time after one Newton step on the gap; a graze too flat for a short step stays as it is."""
    if abs(gap) > abs(rate) * POLISH_TIME:
        return time
    return max(0.0, time - gap / rate)


@kernel
def time_to_border(gap: float, rate: float, bend: float) -> float:
    """When the gap to a straight border is used up: the closed form, polished once."""
    if gap <= 0.0 and rate < 0.0:
        return 0.0
    time = time_to_line(max(gap, 0.0), rate, bend)
    if 0.0 < time < NEVER:
        time = polished(time, gap + time * (rate + 0.5 * bend * time), rate + bend * time)
    return time


@kernel
def flight_to_shape(
    c: Any, part: int, ball: Ball, pull_x: float, pull_z: float, radius: float, limit: float
) -> Contact:
    """The first contact of a ball with a shape that stands still, before `limit` [s].

    Returns:
        The contact; `NOTHING` if there is none before the limit; `PAUSE` with a time up to which the flight
        is free, should the search not have ended (a long graze).
    """
    time = 0.0
    for _ in range(FLIGHT_STEPS):
        here = flown(ball, pull_x, pull_z, time)
        gap, nx, nz = distance(c, here.x, here.z)
        gap -= radius
        rate = nx * here.vx + nz * here.vz
        if gap <= CONTACT_GAP and rate < 0.0:
            time = polished(time, gap, rate)
            here = flown(ball, pull_x, pull_z, time)
            gap, nx, nz = distance(c, here.x, here.z)
            return Contact(time, part, nx, nz)
        bend = nx * pull_x + nz * pull_z
        step = time_to_line(max(gap, 0.0), rate, bend)
        if step == 0.0:  # at rest on the shape and pressed against it
            return Contact(time, part, nx, nz)
        time += step
        if not time < limit:
            return Contact(limit, NOTHING, 0.0, 0.0)
    return Contact(time, PAUSE, 0.0, 0.0)


@kernel
def flight_to_ball(a: Ball, b: Ball, radius: float, limit: float) -> Contact:
    """The first contact of two balls that fall alike: their relative motion is a straight line.

    |p + v·h| = 2r  is  v²·h² + 2(p·v)·h + p² − 4r² = 0; with b = −p·v > 0 and c = p² − 4r² the earlier root
    is c / (b + √(b² − v²·c)): no cancellation. The normal points from b to a.
    """
    px, pz, vx, vz = a.x - b.x, a.z - b.z, a.vx - b.vx, a.vz - b.vz
    toward = -(px * vx + pz * vz)
    nothing = Contact(limit, NOTHING, 0.0, 0.0)
    if toward <= 0.0:
        return nothing
    reach = 2.0 * radius
    c = px * px + pz * pz - reach * reach
    time = 0.0
    if c > 0.0:
        square = toward * toward - (vx * vx + vz * vz) * c
        if square < 0.0:
            return nothing
        time = c / (toward + sqrt(square))
        if not time < limit:
            return nothing
        # Newton on the gap itself: c, a difference of squares, has lost the last digits of a long flight.
        qx, qz = px + vx * time, pz + vz * time
        apart = sqrt(qx * qx + qz * qz)
        time = polished(time, apart - reach, (qx * vx + qz * vz) / apart)
    nx, nz = px + vx * time, pz + vz * time
    apart = sqrt(nx * nx + nz * nz)
    if apart == 0.0:  # only a state from outside holds two balls in one place
        return Contact(0.0, OTHER_BALL, 1.0, 0.0)
    return Contact(time, OTHER_BALL, nx / apart, nz / apart)
