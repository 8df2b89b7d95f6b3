"""Time of impact: the first moment at which a ball in flight touches a shape.

Between contacts a ball flies on a parabola. Let D be the gap between ball and shape, n the unit normal at the
nearest point, D′ = n·v its rate and α = n·a. A convex shape lies wholly behind the line through its nearest
point perpendicular to n, so the ball cannot touch it before it has used up the gap to that line:

    D + D′·h + ½·α·h² = 0,   h the smallest root ≥ 0.

Advance by h and repeat until the gap is closed; one Newton step removes the rest. A flat face is found by the
first step, corners and circles after a few: near the contact the step is Newton's, and it never overshoots.

An arc is convex only as seen from outside its disc. Elsewhere the step is bounded in other ways:

  * At any place the gap lasts at least until |v|·h + ½·|a|·h² = D.
  * Inside the disc, at the distance ρ from the centre, D″ ≥ −(|a| + v²/ρ). The bound holds while ρ stays
    above half of its value, which is itself bounded by the speed.
  * Past the ends the ball meets one of the two end points, which are convex, or it first crosses a line from
    the centre through an end, in a closed form.

A flight is defined by the ball's record: the state at its start, the acceleration, and its age (see
`motion.py`). All times in this file are ages of the flight [s].

Source: conservative advancement (B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996,
ch. 2), with the exact parabola in place of a bound on the speed.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import (
    NOTHING,
    NULL_EVENT,
    OTHER_BALL,
    BallMotion,
    BallRecord,
    ColliderRecord,
    Contact,
    Shape,
)
from silverball.physics.shapes import arc_contact, distance, is_beside_arc, point_distance
from silverball.physics.tolerances import (
    CONTACT_GAP,
    FLIGHT_STEPS,
    MIN_ADVANCE_GAP,
    NEVER,
    NEWTON_TIME,
)

# [u] a larger gap after a search means that it ran out of steps before the contact
MAX_FOUND_GAP = CONTACT_GAP * 100.0


@inlined
def time_to_line(gap: float, rate: float, gap_accel: float) -> float:
    """Compute the smallest root h ≥ 0 [s] of a gap's parabola, for gap ≥ 0; NEVER if there is none.

        gap + rate·h + ½·gap_accel·h² = 0

    Of the two forms of the root it takes the one without cancellation:
    (−rate ∓ √Δ)/gap_accel = 2·gap/(√Δ − rate)  with  Δ = rate² − 2·gap_accel·gap.
    """
    discriminant = rate * rate - 2.0 * gap_accel * gap
    if rate < 0.0:
        return NEVER if discriminant < 0.0 else 2.0 * gap / (sqrt(discriminant) - rate)
    return (rate + sqrt(discriminant)) / -gap_accel if gap_accel < 0.0 else NEVER


@inlined
def stays_open(gap: float, rate: float, gap_accel: float, h: float) -> bool:
    """Whether a gap certainly stays open for h [s], without a root.

    A concave parabola takes its minimum at an endpoint.
    """
    return gap + h * (rate + 0.5 * min(gap_accel, 0.0) * h) > 0.0


@inlined
def state_at(ball: BallRecord, age: float) -> BallMotion:
    """Compute the ball's state at an age of its flight:  p + v·h + ½·a·h²,  v + a·h."""
    return BallMotion(
        ball.start_x + age * (ball.start_vx + 0.5 * ball.accel_x * age),
        ball.start_z + age * (ball.start_vz + 0.5 * ball.accel_z * age),
        ball.start_vx + ball.accel_x * age,
        ball.start_vz + ball.accel_z * age,
    )


@inlined
def newton_refined(time: float, gap: float, rate: float) -> float:
    """Refine a time by one Newton step on the gap.

    For a grazing contact, whose Newton step would be too long, the time is returned unchanged.
    """
    if abs(gap) >= abs(rate) * NEWTON_TIME:  # also where both are 0
        return time
    return max(0.0, time - gap / rate)


@internal
def time_to_border(gap: float, rate: float, gap_accel: float) -> float:
    """Compute when the gap to a straight border closes: the closed form, refined once."""
    if gap <= 0.0 and rate < 0.0:
        return 0.0
    time = time_to_line(max(gap, 0.0), rate, gap_accel)
    if 0.0 < time < NEVER:
        time = newton_refined(time, gap + time * (rate + 0.5 * gap_accel * time), rate + gap_accel * time)
    return time


@kernel
def time_to_shape(
    c: ColliderRecord, ball: BallRecord, radius: float, start: float, limit: float
) -> tuple[float, bool]:
    """Find when a ball first touches a stationary shape, from the age `start` on and before `limit`.

    Returns:
        The age and True; or False and an age up to which there is no contact: the limit, or less if the
        search has not ended (a long graze).
    """
    if c.form == Shape.ARC:
        return _time_to_arc(c, ball, radius, start, limit)
    time = start
    for _ in range(FLIGHT_STEPS):
        state = state_at(ball, time)
        gap, nx, nz = distance(c, state.x, state.z)
        gap -= radius
        rate = nx * state.vx + nz * state.vz
        if gap <= CONTACT_GAP and rate < 0.0:
            return newton_refined(time, gap, rate), True
        gap = max(gap, 0.0)
        gap_accel = nx * ball.accel_x + nz * ball.accel_z
        if stays_open(gap, rate, gap_accel, limit - time):
            return limit, False
        step = time_to_line(gap, rate, gap_accel)
        if step == 0.0:  # at rest on the shape and pressed against it
            return time, True
        time += step
        if not time < limit:
            return limit, False
    return time, False


@for_devices(lambda c, ball, radius, start, limit: (limit, False))
@internal
def _time_to_arc(
    c: ColliderRecord, ball: BallRecord, radius: float, start: float, limit: float
) -> tuple[float, bool]:
    """Find when a ball first touches an arc; arguments and result are those of `time_to_shape`.

    No plain board has an arc.
    """
    accel = sqrt(ball.accel_x * ball.accel_x + ball.accel_z * ball.accel_z)
    state = state_at(ball, start)
    max_speed = sqrt(state.vx * state.vx + state.vz * state.vz) + accel * (limit - start)
    free_radius = c.arc_radius - c.radius - radius  # of the circle on which a ball touches it from inside
    bound = accel + max_speed * max_speed / free_radius if free_radius > 0.0 else accel
    min_step = sqrt(2.0 * MIN_ADVANCE_GAP / bound) if bound > 0.0 else NEVER
    time = start
    for _ in range(FLIGHT_STEPS):
        state = state_at(ball, time)
        gap, nx, nz = arc_contact(c, state.x, state.z, state.vx, state.vz)
        gap -= radius
        rate = nx * state.vx + nz * state.vz
        if gap <= CONTACT_GAP and rate < 0.0:
            return newton_refined(time, gap, rate), True
        gap = max(gap, 0.0)
        gap_accel = nx * ball.accel_x + nz * ball.accel_z
        height = nx * (state.x - c.x2) + nz * (state.z - c.z2)  # over the centre; < 0 inside its disc
        if not is_beside_arc(c, state.x, state.z):
            to_end = min(
                _time_to_point(ball, state, c.x0, c.z0, c.radius + radius),
                _time_to_point(ball, state, c.x1, c.z1, c.radius + radius),
            )
            is_pressed = to_end == 0.0
            least = min_step if rate >= 0.0 else 0.0  # at the line through an end
            step = min(to_end, max(_time_to_angle(c, ball, state), least))
        elif height > 0.0:
            step = time_to_line(gap, rate, gap_accel)
            is_pressed = step == 0.0
        else:
            along = nx * state.vz - nz * state.vx
            opens = -gap_accel * height >= along * along  # the gap's acceleration is ≥ 0
            is_pressed = gap == 0.0 and rate == 0.0 and not opens
            least = min_step if rate >= 0.0 and opens else 0.0  # see MIN_ADVANCE_GAP
            step = least
            if -height > MIN_ADVANCE_GAP:  # elsewhere the bound on the speed is the better one
                bend = accel - 2.0 * max_speed * max_speed / height
                step = max(time_to_line(gap, rate, -bend), least)
                step = min(step, time_to_line(-0.5 * height, -max_speed, -accel))
        if is_pressed:  # at rest on the arc
            return time, True
        speed = sqrt(state.vx * state.vx + state.vz * state.vz)
        time += max(step, time_to_line(gap, -speed, -accel))
        if not time < limit:
            return limit, False
    return time, False


@inlined
def _time_to_point(ball: BallRecord, state: BallMotion, px: float, pz: float, reach: float) -> float:
    """Compute a time [s] for which a ball stays out of `reach` of a point; 0 where it is pressed to it."""
    gap, nx, nz = point_distance(state.x, state.z, px, pz)
    rate = nx * state.vx + nz * state.vz
    return time_to_line(max(gap - reach, 0.0), rate, nx * ball.accel_x + nz * ball.accel_z)


@internal
def _time_to_angle(c: ColliderRecord, ball: BallRecord, state: BallMotion) -> float:
    """Compute a time [s] for which a ball past the ends of an arc stays out of the arc's angle.

    The angle lies between the lines from the centre through the ends: beyond both of them, or, if it is more
    than a half turn, beyond either.
    """
    first = _time_to_tangent_side(ball, state, c.x0, c.z0, c.along_x0, c.along_z0)
    second = _time_to_tangent_side(ball, state, c.x1, c.z1, c.along_x1, c.along_z1)
    return min(first, second) if c.arc_is_major != 0 else max(first, second)


@inlined
def _time_to_tangent_side(
    ball: BallRecord, state: BallMotion, px: float, pz: float, ux: float, uz: float
) -> float:
    """Compute when a ball gets ahead of the point (px, pz) in the direction (ux, uz); 0 if it is."""
    gap = (px - state.x) * ux + (pz - state.z) * uz
    if gap <= 0.0:
        return 0.0
    return time_to_line(gap, -(state.vx * ux + state.vz * uz), -(ball.accel_x * ux + ball.accel_z * uz))


@internal
def contact_with_ball(
    a: BallMotion, b: BallMotion, accel_x: float, accel_z: float, radius: float, limit: float
) -> Contact:
    """Find the first contact of two balls before `limit` [s from now]; the normal points from b to a.

    Args:
        a: The one ball now.
        b: The other ball now.
        accel_x: Difference of their accelerations, a's minus b's [u/s²].
        accel_z: The same in z.
        radius: Of a ball [u].
        limit: The end of the search [s].
    """
    px, pz, vx, vz = a.x - b.x, a.z - b.z, a.vx - b.vx, a.vz - b.vz
    if accel_x == 0.0 and accel_z == 0.0:
        time = _time_to_ball_uniform(px, pz, vx, vz, 2.0 * radius, limit)
    else:
        time = _time_to_ball_accelerated(px, pz, vx, vz, accel_x, accel_z, 2.0 * radius, limit)
    if not time < limit:
        return Contact(limit, NOTHING, 0.0, 0.0)
    nx, nz = px + time * (vx + 0.5 * accel_x * time), pz + time * (vz + 0.5 * accel_z * time)
    apart, nx, nz = point_distance(nx, nz, 0.0, 0.0)
    if apart > 2.0 * radius + MAX_FOUND_GAP:  # the search ran out of steps before the contact
        return Contact(time, NULL_EVENT, 0.0, 0.0)
    return Contact(time, OTHER_BALL, nx, nz)


@inlined
def _time_to_ball_uniform(px: float, pz: float, vx: float, vz: float, reach: float, limit: float) -> float:
    """Compute when two balls with equal accelerations meet: their relative motion p + v·h is uniform.

    |p + v·h| = 2r  is  v²·h² + 2(p·v)·h + p² − 4r² = 0. With b = −p·v > 0 and c = p² − 4r² the earlier root
    is c / (b + √(b² − v²·c)), which has no cancellation.
    """
    toward = -(px * vx + pz * vz)
    if toward <= 0.0:
        return limit
    c = px * px + pz * pz - reach * reach
    if c <= 0.0:
        return 0.0
    discriminant = toward * toward - (vx * vx + vz * vz) * c
    if discriminant < 0.0:
        return limit
    time = c / (toward + sqrt(discriminant))
    if not time < limit:
        return limit
    # Newton on the gap itself: c, a difference of squares, has lost the last digits of a long flight.
    qx, qz = px + vx * time, pz + vz * time
    apart = sqrt(qx * qx + qz * qz)
    return newton_refined(time, apart - reach, (qx * vx + qz * vz) / apart)


@internal
def _time_to_ball_accelerated(
    px: float, pz: float, vx: float, vz: float, accel_x: float, accel_z: float, reach: float, limit: float
) -> float:
    """Compute the same for unequal accelerations, by conservative advancement towards a circle.

    The steps are those of `time_to_shape`.
    """
    time = 0.0
    for _ in range(FLIGHT_STEPS):
        x, z = px + time * (vx + 0.5 * accel_x * time), pz + time * (vz + 0.5 * accel_z * time)
        gap, nx, nz = point_distance(x, z, 0.0, 0.0)
        gap -= reach
        rate = nx * (vx + accel_x * time) + nz * (vz + accel_z * time)
        if gap <= CONTACT_GAP and rate < 0.0:
            return newton_refined(time, gap, rate)
        step = time_to_line(max(gap, 0.0), rate, nx * accel_x + nz * accel_z)
        if step == 0.0:
            return time
        time += step
        if not time < limit:
            return limit
    return time
