"""The paddles: how they turn, and when a ball touches one.

Both paddles are computed as a left one. For the right paddle z is mirrored on the way in (side = −1) and on
the way out, so that mirrored inputs give bit-for-bit mirrored results. A paddle's own frame has its pivot at
the origin, z′ from the pivot to the tip and x′ to the side that lifts; its triangle is fixed in that frame.
At angle θ

    z′ = x·sin θ + z·cos θ,   x′ = x·cos θ − z·sin θ       (x, z from the pivot)

and a surface that turns with ω moves with (ω·r_z, −ω·r_x) at r from the pivot.

A paddle turns at constant speed, or as a coil drives it: with the constant angular acceleration α from
standstill, so that a whole stroke takes the time √(2·Δθ/α). A coil's paddle that changes its direction starts
from standstill again.
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
    PaddleRecord,
    PaddleSweep,
    Shape,
    SweepRecord,
)
from silverball.physics.shapes import point_distance, tapered_distance
from silverball.physics.tolerances import CONTACT_GAP, FLIGHT_STEPS, MIN_ADVANCE_GAP, NEVER


@inlined
def start_sweep(c: ColliderRecord, paddle: PaddleRecord, raised: bool) -> PaddleSweep:
    """Set a paddle's motion in a tick: from its present angle to its button's stop."""
    angle, stop = paddle.angle, c.angle_up if raised else c.angle_rest
    omega, alpha = 0.0, 0.0
    if angle < stop:
        omega, alpha = c.lift_speed, c.lift_accel
    elif angle > stop:
        omega, alpha = -c.return_speed, -c.return_accel
    if alpha != 0.0:
        omega = _carried_speed(paddle.angular_velocity, omega)
    return PaddleSweep(angle, omega, stop, alpha)


@inlined
def _carried_speed(omega: float, max_omega: float) -> float:
    """Limit an angular velocity [rad/s] to the range 0 … max_omega, of either sign; NaN gives 0."""
    speed, max_speed = (omega, max_omega) if max_omega > 0.0 else (-omega, -max_omega)
    speed = min(speed, max_speed) if speed > 0.0 else 0.0
    return speed if max_omega > 0.0 else -speed


@inlined
def is_turning(paddle: PaddleSweep) -> bool:
    """Whether the paddle moves in this tick."""
    return paddle.omega != 0.0 or paddle.alpha != 0.0


@inlined
def read_sweep(record: SweepRecord) -> PaddleSweep:
    """Read a paddle's motion in the present tick."""
    return PaddleSweep(record.angle, record.omega, record.stop, record.alpha)


@inlined
def write_sweep(record: SweepRecord, paddle: PaddleSweep, stop_time: float) -> None:
    """Write a paddle's motion in the present tick, and when it reaches its stop [s]."""
    record.angle, record.omega, record.stop = paddle.angle, paddle.omega, paddle.stop
    record.alpha, record.stop_time = paddle.alpha, stop_time


@inlined
def reaches_stop(paddle: PaddleSweep, tick: float) -> bool:
    """Whether the paddle turns and reaches its stop within the tick."""
    return is_turning(paddle) and angle_at(paddle, tick) == paddle.stop


@inlined
def time_to_stop(paddle: PaddleSweep, tick: float) -> float:
    """Compute when in the tick the paddle reaches its stop [s]; NEVER if it does not.

    With the way δ to the stop, ω·t + ½·α·t² = δ gives t = 2·δ / (ω ± √(ω² + 2·α·δ)), with the sign of δ.
    """
    if not reaches_stop(paddle, tick):
        return NEVER
    way = paddle.stop - paddle.angle
    if paddle.alpha == 0.0:
        return min(way / paddle.omega, tick)
    speed_at_stop = sqrt(paddle.omega * paddle.omega + 2.0 * paddle.alpha * way)
    return min(2.0 * abs(way) / (abs(paddle.omega) + speed_at_stop), tick)


@inlined
def angle_at(paddle: PaddleSweep, time: float) -> float:
    """Compute the angle at a time of the tick, never beyond the stop."""
    angle = paddle.angle + (paddle.omega + 0.5 * paddle.alpha * time) * time
    return min(angle, paddle.stop) if paddle.angle < paddle.stop else max(angle, paddle.stop)


@inlined
def omega_at(paddle: PaddleSweep, time: float) -> float:
    """Compute the angular velocity [rad/s] at a time of the tick before it reaches its stop."""
    return paddle.omega + paddle.alpha * time


@inlined
def end_at_stop(paddle: PaddleSweep) -> PaddleSweep:
    """Place a paddle at its stop, where its angle is exact and it no longer turns."""
    return PaddleSweep(paddle.stop, 0.0, paddle.stop, 0.0)


@inlined
def surface_velocity(c: ColliderRecord, omega: float, x: float, z: float) -> tuple[float, float]:
    """Compute the velocity [u/s] of the turning paddle's surface at (x, z) [u]:  ω × r."""
    rx = x - c.x
    rz = c.side * (z - c.z)
    return omega * rz, c.side * (-omega * rx)


@inlined
def surface_acceleration(c: ColliderRecord, paddle: PaddleSweep, time: float) -> float:
    """Bound the acceleration [u/s²] of the paddle's surface at a time of the tick:  (ω² + |α|)·ρ."""
    omega = omega_at(paddle, time)
    return omega * omega * c.reach + abs(paddle.alpha) * c.reach


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
    """Compute the distance from the paddle's outline in its own frame, and the unit normal there.

    A triangle is symmetric about the line from pivot to tip, so a point below it is mirrored to the upper
    side. What is left is the flank from the tip (corner 1) to the base's end (corner 2), and the base.
    """
    if c.form == Shape.TAPERED:
        return tapered_distance(c, x, z)
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

        A = |a| + 2·|ω|·v + (ω² + |α|)·ρ,

    where ω and v bound the angular velocity and the ball's speed up to the time limit, and ρ bounds its
    distance from the pivot while contact is possible. `speed` is the ball's at the start, where it is within
    reach of the paddle.
    """
    limit, is_moving = best.time, is_turning(paddle)
    omega, bound, min_step, sine, cosine = 0.0, 0.0, 0.0, 0.0, 1.0
    angle = paddle.angle
    if is_moving:
        omega = max(abs(omega_at(paddle, start)), abs(omega_at(paddle, limit)))
        accel = abs(ball.accel_x) + abs(ball.accel_z)
        max_speed = speed + accel * (limit - start)
        max_distance = c.reach + radius + 2.0 * max_speed * (limit - start)
        bound = accel + 2.0 * omega * max_speed + omega * omega * max_distance
        bound += abs(paddle.alpha) * max_distance
        min_step = sqrt(2.0 * MIN_ADVANCE_GAP / bound)
    else:
        sine, cosine = stationary_sine_cosine(c, angle)
    time = start
    for _ in range(FLIGHT_STEPS):
        state = state_at(ball, ball.age + time)
        if is_moving:
            angle, omega = angle_at(paddle, time), omega_at(paddle, time)
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
            gap, nx, nz = paddle_distance(c, angle_at(paddle, time) if is_moving else angle, state.x, state.z)
            return Contact(time, row, nx, nz)
        gap_accel = nx * ball.accel_x + nz * ball.accel_z if not is_moving else -bound
        gap = max(gap, 0.0)
        if stays_open(gap, rate, gap_accel, limit - time):
            return best
        step = time_to_line(gap, rate, gap_accel)
        if not is_moving:
            if step == 0.0:  # at rest on the paddle and pressed against it
                return Contact(time, row, nx, nz)
        elif step < min_step and rate >= 0.0:
            # The ball runs along with the surface: advance, at most MIN_ADVANCE_GAP too far.
            step = min_step
        time += step
        if not time < limit:
            return best
    return Contact(time, NULL_EVENT, 0.0, 0.0)
