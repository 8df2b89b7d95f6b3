"""The paddles: how they turn, and when a ball touches one.

Both paddles are computed as a left one. For the right paddle z is mirrored on the way in (side = −1) and on
the way out, so that mirrored inputs give bit-for-bit mirrored results. A paddle's own frame has its pivot at
the origin, z′ from the pivot to the tip and x′ to the side that lifts; its triangle is fixed in that frame.
At angle θ

    z′ = x·sin θ + z·cos θ,   x′ = x·cos θ − z·sin θ       (x, z from the pivot)

and a surface that turns with ω moves with (ω·r_z, −ω·r_x) at r from the pivot.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.flight import newton_refined, state_at, stays_open, time_to_line
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.portable_math import sine_cosine
from silverball.physics.records import (
    NULL_EVENT,
    BallRecord,
    ColliderRecord,
    Contact,
    PaddleSweep,
    SweepRecord,
)
from silverball.physics.shapes import point_distance
from silverball.physics.tolerances import CONTACT_GAP, FLIGHT_STEPS, MIN_ADVANCE_GAP, NEVER


@inlined
def start_sweep(c: ColliderRecord, angle: float, raised: bool) -> PaddleSweep:
    """Set a paddle's motion in a tick: from this angle, at constant speed, to its button's stop."""
    stop = c.angle_up if raised else c.angle_rest
    omega = 0.0
    if angle < stop:
        omega = c.lift_speed
    elif angle > stop:
        omega = -c.return_speed
    return PaddleSweep(angle, omega, stop)


@inlined
def read_sweep(record: SweepRecord) -> PaddleSweep:
    """Read a paddle's motion in the present tick."""
    return PaddleSweep(record.angle, record.omega, record.stop)


@inlined
def write_sweep(record: SweepRecord, paddle: PaddleSweep, stop_time: float) -> None:
    """Write a paddle's motion in the present tick, and when it reaches its stop [s]."""
    record.angle, record.omega, record.stop, record.stop_time = (
        paddle.angle,
        paddle.omega,
        paddle.stop,
        stop_time,
    )


@inlined
def reaches_stop(paddle: PaddleSweep, tick: float) -> bool:
    """Whether the paddle turns and reaches its stop within the tick."""
    return paddle.omega != 0.0 and angle_at(paddle, tick) == paddle.stop


@inlined
def time_to_stop(paddle: PaddleSweep, tick: float) -> float:
    """Compute when in the tick the paddle reaches its stop [s]; NEVER if it does not."""
    return min((paddle.stop - paddle.angle) / paddle.omega, tick) if reaches_stop(paddle, tick) else NEVER


@inlined
def angle_at(paddle: PaddleSweep, time: float) -> float:
    """Compute the angle at a time of the tick, never beyond the stop."""
    angle = paddle.angle + paddle.omega * time
    return min(angle, paddle.stop) if paddle.omega > 0.0 else max(angle, paddle.stop)


@inlined
def end_at_stop(paddle: PaddleSweep) -> PaddleSweep:
    """Place a paddle at its stop, where its angle is exact and it no longer turns."""
    return PaddleSweep(paddle.stop, 0.0, paddle.stop)


@inlined
def stop_sweep(paddle: PaddleSweep, time: float) -> PaddleSweep:
    """Stop a paddle where it is at a time of the tick."""
    if paddle.omega == 0.0:
        return paddle
    return PaddleSweep(angle_at(paddle, time), 0.0, paddle.stop)


@inlined
def surface_velocity(c: ColliderRecord, omega: float, x: float, z: float) -> tuple[float, float]:
    """Compute the velocity [u/s] of the turning paddle's surface at (x, z) [u]:  ω × r."""
    rx = x - c.x
    rz = c.side * (z - c.z)
    return omega * rz, c.side * (-omega * rx)


@kernel
def paddle_distance(c: ColliderRecord, angle: float, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance of a point from a paddle at an angle, and the unit normal there."""
    sine, cosine = sine_cosine(angle)
    return _distance_turned(c, sine, cosine, x, z)


@inlined
def stationary_sine_cosine(c: ColliderRecord, angle: float) -> tuple[float, float]:
    """Compute sine and cosine of a stationary paddle's angle; they are precomputed at both stops."""
    if angle == c.angle_rest:
        return c.sine_rest, c.cosine_rest
    if angle == c.angle_up:
        return c.sine_up, c.cosine_up
    return sine_cosine(angle)


@inlined
def _distance_turned(
    c: ColliderRecord, sine: float, cosine: float, x: float, z: float
) -> tuple[float, float, float]:
    rx = x - c.x
    rz = c.side * (z - c.z)
    gap, nx, nz = _outline_distance(c, rx * cosine - rz * sine, rx * sine + rz * cosine)
    return gap, nx * cosine + nz * sine, c.side * (nz * cosine - nx * sine)


@inlined
def _outline_distance(c: ColliderRecord, x: float, z: float) -> tuple[float, float, float]:
    """Compute the distance from the paddle's triangle in its own frame, and the unit normal there.

    The triangle is symmetric about the line from pivot to tip, so a point below it is mirrored to the upper
    side. What is left is the flank from the tip (corner 1) to the base's end (corner 2), and the base.
    """
    side = 1.0 if x >= 0.0 else -1.0
    x = abs(x)
    flank_distance = (z - c.z1) * c.along_x1 - x * c.along_z1
    if flank_distance < -z:
        if x > c.x2:
            gap, nx, nz = point_distance(x, z, c.x2, 0.0)
        else:
            gap, nx, nz = -z, 0.0, -1.0
    else:
        along_flank = x * c.along_x1 + (z - c.z1) * c.along_z1
        if flank_distance > 0.0 and along_flank < 0.0:
            gap, nx, nz = point_distance(x, z, 0.0, c.z1)
        elif flank_distance > 0.0 and along_flank > c.length1:
            gap, nx, nz = point_distance(x, z, c.x2, 0.0)
        else:
            gap, nx, nz = flank_distance, -c.along_z1, c.along_x1
    return gap, side * nx, nz


@internal
def contact_with_paddle(
    c: ColliderRecord,
    row: int,
    paddle: PaddleSweep,
    ball: BallRecord,
    radius: float,
    speed: float,
    start: float,
    best: Contact,
) -> Contact:
    """Find the first contact of a ball with a paddle from a time of the tick on, or return an earlier `best`.

    In the frame of a turning paddle the flight is not a parabola, so n·a is replaced by its bound −A,

        A = |a| + 2·|ω|·v + ω²·ρ,

    where v bounds the ball's speed up to the time limit, and ρ bounds its distance from the pivot while
    contact is possible. `speed` is the ball's at the start, where it is within reach of the paddle.
    """
    omega, limit = paddle.omega, best.time
    bound, min_step, sine, cosine = 0.0, 0.0, 0.0, 1.0
    angle = paddle.angle
    if omega != 0.0:
        accel = abs(ball.accel_x) + abs(ball.accel_z)
        max_speed = speed + accel * (limit - start)
        max_distance = c.reach + radius + 2.0 * max_speed * (limit - start)
        bound = accel + 2.0 * abs(omega) * max_speed + omega * omega * max_distance
        min_step = sqrt(2.0 * MIN_ADVANCE_GAP / bound)
    if omega == 0.0:
        sine, cosine = stationary_sine_cosine(c, angle)
    time = start
    for _ in range(FLIGHT_STEPS):
        state = state_at(ball, ball.age + time)
        if omega != 0.0:
            angle = angle_at(paddle, time)
            sine, cosine = sine_cosine(angle)
        gap, nx, nz = _distance_turned(c, sine, cosine, state.x, state.z)
        gap -= radius
        ux, uz = surface_velocity(c, omega, state.x, state.z)
        rate = nx * (state.vx - ux) + nz * (state.vz - uz)
        if gap <= CONTACT_GAP and rate < 0.0:
            time = max(start, newton_refined(time, gap, rate))
            if not time < limit:
                return best
            state = state_at(ball, ball.age + time)
            gap, nx, nz = paddle_distance(
                c, angle_at(paddle, time) if omega != 0.0 else angle, state.x, state.z
            )
            return Contact(time, row, nx, nz)
        gap_accel = nx * ball.accel_x + nz * ball.accel_z if omega == 0.0 else -bound
        gap = max(gap, 0.0)
        if stays_open(gap, rate, gap_accel, limit - time):
            return best
        step = time_to_line(gap, rate, gap_accel)
        if omega == 0.0:
            if step == 0.0:  # at rest on the paddle and pressed against it
                return Contact(time, row, nx, nz)
        elif step < min_step and rate >= 0.0:
            # The ball runs along with the surface: advance, at most MIN_ADVANCE_GAP too far.
            step = min_step
        time += step
        if not time < limit:
            return best
    return Contact(time, NULL_EVENT, 0.0, 0.0)
