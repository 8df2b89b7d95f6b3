"""Tapered paddles and coil strokes: distances, motion, times of contacts."""

from __future__ import annotations

import math

import mpmath
import numba
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from mpmath import mpf

from contact_times import BOUND, exact, first_root, length
from rows_of import RADIUS, ball_at, first_meeting, row_of
from silverball.physics.paddle import (
    omega_at,
    paddle_distance,
    start_sweep,
    time_to_stop,
)
from silverball.physics.records import PADDLE, PaddleSweep, Shape, records
from silverball.table.primitive import Mover, Primitive

PIVOT, LENGTH, BASE, TIP = (-7.2, -2.5), 1.15, 0.2, 0.12
REST, UP = math.radians(-30.0), math.radians(22.0)
STROKE, RETURN = 0.03, 0.1
FLIGHTS = 120


def paddle_row(shape=Shape.TAPERED, direction: float = 1.0, is_coil: bool = False, **more):
    points = ((0.0, 0.0), (0.0, LENGTH)) if shape == Shape.TAPERED else ((-0.25, 0), (0, LENGTH), (0.25, 0))
    mover = Mover(PIVOT, direction, REST, UP, STROKE, RETURN, "left", is_coil=is_coil, **more)
    return row_of(Primitive(shape, points, BASE, TIP, mover=mover))


def tapered_gap(x, z, angle, direction: float = 1.0):
    """Distance of a ball from the hull of two circles: from the nearest of the circles between them."""
    is_exact = isinstance(angle, mpf)
    sine, cosine = (mpmath.sin(angle), mpmath.cos(angle)) if is_exact else (np.sin(angle), np.cos(angle))
    number = exact if is_exact else float
    dx, dz = x - number(PIVOT[0]), (z - number(PIVOT[1])) * number(direction)
    across, along = abs(dx * cosine - dz * sine), dx * sine + dz * cosine
    fall = (number(BASE) - number(TIP)) / number(LENGTH)
    root = mpmath.sqrt if is_exact else np.sqrt
    place = along - across * fall / root(1 - fall * fall)
    center = min(max(place, mpf(0)), number(LENGTH)) if is_exact else np.clip(place, 0.0, LENGTH)
    return length(across, along - center) - (number(BASE) - fall * center) - number(RADIUS)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_the_distance_is_that_from_a_hull_of_many_points(direction: float) -> None:
    row = paddle_row(direction=direction)
    share, turn = np.meshgrid(np.linspace(0, 1, 3000), np.linspace(-math.pi, math.pi, 721))
    # The surface of every circle between base and tip; those inside of others are further away.
    radius = BASE + share * (TIP - BASE)
    xs, zs = radius * np.sin(turn), share * LENGTH + radius * np.cos(turn)
    rng = np.random.default_rng(1)
    for _ in range(60):
        angle, x, z = rng.uniform(REST, UP), *(PIVOT + rng.uniform(-2, 2, 2))
        gap, nx, nz = paddle_distance(row, angle, x, z)
        if gap <= 0.01:
            continue
        dx, dz = x - PIVOT[0], direction * (z - PIVOT[1])
        px, pz = dx * math.cos(angle) - dz * math.sin(angle), dx * math.sin(angle) + dz * math.cos(angle)
        assert gap == pytest.approx(np.hypot(px - xs, pz - zs).min(), abs=2e-5 / gap + 2e-5)
        near = paddle_distance(row, angle, x - gap * nx, z - gap * nz)[0]
        assert (near, math.hypot(nx, nz)) == pytest.approx((0.0, 1.0), abs=1e-12)


@numba.njit(error_model="numpy")
def _start(c, paddle, raised):  # pragma: no cover  (compiled)
    return start_sweep(c, paddle, raised)


@numba.njit(error_model="numpy")
def _stop_time(sweep, tick):  # pragma: no cover  (compiled)
    return time_to_stop(sweep, tick)


@numba.njit(error_model="numpy")
def _end_of(c, paddle, raised, tick):  # pragma: no cover  (compiled)
    sweep = start_sweep(c, paddle, raised)
    return min(time_to_stop(sweep, tick), tick), omega_at(sweep, min(time_to_stop(sweep, tick), tick))


def state_of(angle: float, omega: float = 0.0):
    paddle = records(1, PADDLE)[0]
    paddle["angle"], paddle["angular_velocity"] = angle, omega
    return paddle


SWING = UP - REST
ALPHA = 2 * SWING / STROKE**2


@pytest.mark.parametrize("tick", [1 / 60, 1 / 240, 1 / 1000])
def test_a_coil_stroke_takes_its_time_and_ends_at_twice_the_mean_speed(tick: float) -> None:
    row, angle, omega, time = paddle_row(is_coil=True), REST, 0.0, 0.0
    while angle < UP:
        sweep = _start(row, state_of(angle, omega), True)
        assert sweep[1] == pytest.approx(ALPHA * time, rel=1e-12)
        assert sweep[3] == pytest.approx(ALPHA)
        stop, end_omega = _end_of(row, state_of(angle, omega), True, tick)
        time += stop
        angle = UP if stop < tick else angle + (sweep[1] + 0.5 * sweep[3] * tick) * tick
        omega = end_omega
        if angle < UP:
            assert angle == pytest.approx(REST + 0.5 * ALPHA * time**2, abs=1e-13)
    assert time == pytest.approx(STROKE, rel=1e-12)
    assert omega == pytest.approx(2 * SWING / STROKE, rel=1e-12)
    assert _start(row, state_of(UP, omega), True) == (UP, 0.0, UP, 0.0)


def test_a_coil_paddle_that_turns_back_starts_from_standstill() -> None:
    row, middle = paddle_row(is_coil=True), (REST + UP) / 2
    back = 2 * SWING / RETURN**2
    assert _start(row, state_of(middle, 20.0), False) == pytest.approx((middle, 0.0, REST, -back))
    assert _start(row, state_of(middle, -4.0), False) == pytest.approx((middle, -4.0, REST, -back))
    assert _start(row, state_of(middle, -4.0), True) == pytest.approx((middle, 0.0, UP, ALPHA))


@pytest.mark.parametrize("omega", [math.nan, math.inf, -math.inf, 1e300, -1e300])
def test_an_impossible_speed_is_limited_to_that_at_the_end_of_a_stroke(omega: float) -> None:
    row, middle = paddle_row(is_coil=True), (REST + UP) / 2
    for raised, fastest in ((True, 2 * SWING / STROKE), (False, -2 * SWING / RETURN)):
        found = _start(row, state_of(middle, omega), raised)[1]
        assert found in (0.0, pytest.approx(fastest))


def test_the_time_to_a_stop_has_fifty_digits_to_compare_with() -> None:
    rng = np.random.default_rng(2)
    with mpmath.workdps(50):
        for _ in range(200):
            angle, omega = float(rng.uniform(REST, UP)), float(rng.uniform(0, 60))
            alpha = float(rng.choice([0.0, 1.0, 2000.0]))
            sign = float(rng.choice([-1.0, 1.0]))
            stop = UP if sign > 0 else REST
            time = _stop_time(PaddleSweep(angle, sign * omega, stop, sign * alpha), 10.0)
            way = abs(exact(stop) - exact(angle))
            exactly = 2 * way / (omega + mpmath.sqrt(exact(omega) ** 2 + 2 * exact(alpha) * way))
            assert abs(time - exactly) <= 4e-16 * exactly + 4e-16 / max(omega, 1e-3) * abs(stop)


MOTIONS = {
    "resting": (PaddleSweep(REST, 0.0, REST, 0.0), 0.1),
    "constant": (PaddleSweep(REST, SWING / STROKE, UP, 0.0), STROKE),
    "returning": (PaddleSweep(UP, -SWING / RETURN, REST, 0.0), RETURN),
    "coil": (PaddleSweep(REST, 0.0, UP, ALPHA), STROKE),
    "coil in motion": (PaddleSweep(REST, 10.0, UP, ALPHA), 0.02),
}


def meeting_balls(motion: str, seed: int, direction: float = 1.0):
    """Balls that start within reach of a turning paddle, in any direction."""
    rng = np.random.default_rng(seed)
    while True:
        turn, out = rng.uniform(REST - 0.2, UP + 0.2), rng.uniform(0.1, LENGTH + 0.5)
        way, speed = rng.uniform(0, 2 * math.pi), rng.uniform(0.0, 21.0)
        x = PIVOT[0] + out * math.sin(turn) + rng.uniform(-0.3, 0.9)
        z = PIVOT[1] + direction * out * math.cos(turn)
        yield tuple(float(n) for n in (x, z, speed * math.sin(way), speed * math.cos(way)))


def paddle_gap(ball, sweep, direction: float = 1.0):
    def gap(t):
        is_exact = isinstance(t, mpf)
        number = exact if is_exact else float
        x, z, vx, vz = (number(n) for n in ball)
        angle = number(sweep.angle) + number(sweep.omega) * t + number(sweep.alpha) * t * t / 2
        return tapered_gap(x + vx * t - 5 * t * t, z + vz * t, angle, direction)

    return gap


@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize("motion", MOTIONS)
def test_hit_times_on_tapered_paddles(motion: str, direction: float) -> None:
    sweep, limit = MOTIONS[motion]
    row, seen, worst = paddle_row(direction=direction, is_coil=True), 0, 0.0
    balls = meeting_balls(motion, 3, direction)
    while seen < (FLIGHTS if direction > 0 else FLIGHTS // 3):
        ball = next(balls)
        gap = paddle_gap(ball, sweep, direction)
        with mpmath.workdps(50):
            found = first_root(gap, limit)
            if found is None:
                continue
            root, rate = found
            time, part, nx, nz = first_meeting(row, sweep, ball_at(*ball, accel=(-10.0, 0.0)), RADIUS, limit)
            assert part == 3, ball
            error = float(abs(time - root) * abs(rate) / BOUND)
        assert error <= 1.0, (ball, time, root)
        assert math.hypot(nx, nz) == pytest.approx(1.0)
        worst, seen = max(worst, error), seen + 1
    print(f"{motion} tapered paddle: worst {worst:.3f} of 8·ulp(10)/|D′| in {seen} flights")


@settings(max_examples=300, deadline=None)
@given(
    st.tuples(st.floats(-9, -5), st.floats(-3.5, 0), st.floats(-15, 15), st.floats(-15, 15)),
    st.sampled_from(sorted(MOTIONS)),
)
def test_a_ball_is_never_deep_in_a_paddle_before_their_contact(ball, motion: str) -> None:
    sweep, limit = MOTIONS[motion]
    gap = paddle_gap(ball, sweep)
    if gap(np.array([0.0]))[0] < 1e-9:
        return
    time, part, _, _ = first_meeting(
        paddle_row(is_coil=True), sweep, ball_at(*ball, accel=(-10, 0)), RADIUS, limit
    )
    assert gap(np.linspace(0, time, 400)).min() > -1e-9
    if part == 3:
        assert abs(gap(np.array([time]))[0]) < 1e-9
