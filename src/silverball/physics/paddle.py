"""How do the paddles turn, and when does a ball meet one of them?

Both paddles are worked out as a left one: for the right paddle z is mirrored on the way in (side = −1) and
on the way out, so that mirrored play gives mirrored bits. A paddle's own frame has its pivot at the origin,
z′ from the pivot to the tip and x′ to the side that lifts; its triangle is fixed in there. At angle θ

    z′ = x·sin θ + z·cos θ,   x′ = x·cos θ − z·sin θ       (x, z from the pivot)

and a surface that turns with ω moves with (ω·r_z, −ω·r_x) at r from the pivot.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from silverball.physics.flight import flown, polished, time_to_line
from silverball.physics.kernel import inlined, kernel
from silverball.physics.layout import NOTHING, PAUSE, Ball, Contact, Paddle
from silverball.physics.shapes import triangle_distance
from silverball.physics.tolerances import CONTACT_GAP, FLIGHT_STEPS, LEAST_ADVANCE_GAP, NEVER
from silverball.physics.trigonometry import sine_cosine


@inlined
def aimed(c: Any, angle: float, raised: bool) -> tuple[Paddle, float]:
    """A paddle at a tick's start, turning at constant speed, and the stop that its button commands."""
    stop = c.angle_up if raised else c.angle_rest
    if angle < stop:
        return Paddle(angle, c.lift_speed, (stop - angle) / c.lift_speed), stop
    if angle > stop:
        return Paddle(angle, -c.return_speed, (angle - stop) / c.return_speed), stop
    return Paddle(angle, 0.0, NEVER), stop


@inlined
def turned(paddle: Paddle, stop: float, h: float) -> Paddle:
    """The paddle h seconds later; at its stop the angle is set to it exactly and the turning ends."""
    if paddle.turn == 0.0:
        return paddle
    if h >= paddle.stop_in:
        return Paddle(stop, 0.0, NEVER)
    angle = paddle.angle + paddle.turn * h
    angle = min(angle, stop) if paddle.turn > 0.0 else max(angle, stop)  # rounding must not carry it past
    return Paddle(angle, paddle.turn, paddle.stop_in - h)


@inlined
def surface_velocity(c: Any, turn: float, x: float, z: float) -> tuple[float, float]:
    """Velocity [u/s] of the turning paddle's surface at (x, z) [u]:  ω × r."""
    rx = x - c.x
    rz = c.side * (z - c.z)
    return turn * rz, c.side * (-turn * rx)


@kernel
def paddle_distance(c: Any, angle: float, x: float, z: float) -> tuple[float, float, float]:
    """Distance of a point from a paddle at an angle, and the unit normal there."""
    sine, cosine = sine_cosine(angle)
    return _distance_turned(c, sine, cosine, x, z)


@inlined
def _distance_turned(c: Any, sine: float, cosine: float, x: float, z: float) -> tuple[float, float, float]:
    rx = x - c.x
    rz = c.side * (z - c.z)
    gap, nx, nz = triangle_distance(c, rx * cosine - rz * sine, rx * sine + rz * cosine)
    return gap, nx * cosine + nz * sine, c.side * (nz * cosine - nx * sine)


@kernel
def flight_to_paddle(
    c: Any, part: int, paddle: Paddle, ball: Ball, pull_x: float, pull_z: float, radius: float, limit: float
) -> Contact:
    """The first contact of a ball with a paddle before `limit` [s], at most the time of the paddle's stop.

    In the frame of a turning paddle the flight is no parabola, so the bend n·a is replaced by its bound −A,
        A = |a| + 2·|ω|·v + ω²·ρ,
    with v the ball's largest speed on the board and ρ its largest distance from the pivot before the limit.
    """
    turn = paddle.turn
    pull = sqrt(pull_x * pull_x + pull_z * pull_z)
    bound = pull
    if turn != 0.0:
        fastest = sqrt(ball.vx * ball.vx + ball.vz * ball.vz) + pull * limit
        furthest = sqrt((ball.x - c.x) ** 2 + (ball.z - c.z) ** 2) + fastest * limit
        bound = pull + 2.0 * abs(turn) * fastest + turn * turn * furthest
    least = sqrt(2.0 * LEAST_ADVANCE_GAP / bound) if bound > 0.0 else limit
    sine, cosine = sine_cosine(paddle.angle)
    time = 0.0
    for _ in range(FLIGHT_STEPS):
        here = flown(ball, pull_x, pull_z, time)
        if turn != 0.0:
            sine, cosine = sine_cosine(paddle.angle + turn * time)
        gap, nx, nz = _distance_turned(c, sine, cosine, here.x, here.z)
        gap -= radius
        ux, uz = surface_velocity(c, turn, here.x, here.z)
        rate = nx * (here.vx - ux) + nz * (here.vz - uz)
        if gap <= CONTACT_GAP and rate < 0.0:
            time = polished(time, gap, rate)
            here = flown(ball, pull_x, pull_z, time)
            gap, nx, nz = paddle_distance(c, paddle.angle + turn * time, here.x, here.z)
            return Contact(time, part, nx, nz)
        bend = nx * pull_x + nz * pull_z if turn == 0.0 else -bound
        step = time_to_line(max(gap, 0.0), rate, bend)
        if turn == 0.0:
            if step == 0.0:  # at rest on the paddle and pressed against it
                return Contact(time, part, nx, nz)
        elif (
            step < least and rate >= 0.0
        ):  # side by side with the surface: get on, at most LEAST_ADVANCE_GAP too far
            step = least
        time += step
        if not time < limit:
            return Contact(limit, NOTHING, 0.0, 0.0)
    return Contact(time, PAUSE, 0.0, 0.0)
