"""One-way parts block from one side and let pass from the other: against 50 digits and fine sampling."""

from __future__ import annotations

import itertools
import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from flights import TIME_BOUND, exact_path, flight, float_positions, random_flight, segment
from silverball.physics.one_way import time_to_one_way

RADIUS = 0.25  # [u] of the ball
THICKNESS = 0.07
REACH = RADIUS + THICKNESS
LIMIT = 1.2  # [s]
SAMPLES = 4000
FLIGHTS = 3000
GATE = segment((0.0, -1.0), (0.0, 1.0), THICKNESS)  # balls pass upwards
ACCELERATIONS = ("gravity", "any", "none")


def first_contact(gate, ball, start: float = 0.0, limit: float = LIMIT) -> float:
    """The age of the first contact, or inf."""
    age, is_hit = time_to_one_way(gate, ball, RADIUS, start, limit)
    assert is_hit == (age < limit)
    return age if is_hit else math.inf


def gate_and_flight(rng, accel: str):
    """A one-way capsule at any angle, with its ends, and a flight that passes near it."""
    start, turn, length = rng.uniform(-1.0, 1.0, 2), rng.uniform(0.0, 2 * math.pi), rng.uniform(0.3, 2.0)
    end = start + length * np.array([math.sin(turn), math.cos(turn)])
    targets = start + rng.uniform(-0.3, 1.3, (2, 1)) * (end - start) + rng.normal(0.0, 0.4, (2, 2))
    return segment(start.tolist(), end.tolist(), THICKNESS), random_flight(rng, accel, targets)


def frame(gate, x, z):
    """Foot on the axis from corner 0, and height over it in the direction in which balls pass."""
    dx, dz = x - float(gate["x0"]), z - float(gate["z0"])
    return (
        dx * float(gate["along_x0"]) + dz * float(gate["along_z0"]),
        dx * float(gate["inward_x"]) + dz * float(gate["inward_z"]),
    )


def depth(gate, foot, height):
    """The depth below the outline of the whole capsule [u]."""
    beyond = np.maximum(np.maximum(-foot, foot - float(gate["length0"])), 0.0)
    return REACH - np.sqrt(beyond * beyond + height * height)


def sampled_contact(gate, ball) -> tuple[float, float] | None:
    """The samples before and after the ball first enters the upper half of the capsule by its outline, and
    not through the axis; None if it never does."""
    times = np.linspace(0.0, LIMIT, SAMPLES)
    foot, height = frame(gate, *float_positions(ball, times))
    inside = (depth(gate, foot, height) > 0.0) & (height > 0.0)
    for index in np.flatnonzero(inside[1:] & ~inside[:-1]):
        fine = np.linspace(times[index], times[index + 1], 200)
        foot, height = frame(gate, *float_positions(ball, fine))
        within = (depth(gate, foot, height) > 0.0) & (height > 0.0)
        entry = int(np.flatnonzero(within)[0])
        if height[entry - 1] > 0.0:
            return float(times[index]), float(times[index + 1])
    return None


def exact_depth_and_rate(gate, ball, age: float):
    """Depth below the outline, its rate and the height over the axis, exactly."""
    position, velocity = exact_path(ball)
    (x, z), (vx, vz) = position(mpf(age)), velocity(mpf(age))
    p, q = (mpf(float(gate["x0"])), mpf(float(gate["z0"]))), (mpf(float(gate["x1"])), mpf(float(gate["z1"])))
    dx, dz = q[0] - p[0], q[1] - p[1]
    length = mpmath.sqrt(dx * dx + dz * dz)
    share = min(max(((x - p[0]) * dx + (z - p[1]) * dz) / length**2, mpf(0)), mpf(1))
    ex, ez = x - p[0] - share * dx, z - p[1] - share * dz
    apart = mpmath.sqrt(ex * ex + ez * ez)
    return mpf(REACH) - apart, -(ex * vx + ez * vz) / apart, ((x - p[0]) * dz - (z - p[1]) * dx) / length


@pytest.mark.parametrize("accel", ACCELERATIONS)
def test_no_contact_is_missed_and_none_is_false(accel: str) -> None:
    """A contact found must be exact: on the outline, inwards, on the blocked side. So it is no false one, and
    none is missed if it is not later than the first one that the samples show."""
    rng = np.random.default_rng(5)
    worst, hits = 0.0, 0
    for _ in range(FLIGHTS):
        gate, ball = gate_and_flight(rng, accel)
        found, sampled = first_contact(gate, ball), sampled_contact(gate, ball)
        assert found <= (math.inf if sampled is None else sampled[1] + 1e-12), (gate, ball)
        if found < math.inf:
            hits += 1
            with mpmath.workdps(50):
                excess, rate, height = exact_depth_and_rate(gate, ball, found)
            assert rate > 0
            assert height >= -1e-12
            worst = max(worst, float(abs(excess)) / TIME_BOUND)
    print(f"one-way, {accel}: {hits} contacts in {FLIGHTS} flights, worst gap {worst:.3f} of 8·ulp(10)")
    assert 0.2 < hits / FLIGHTS < 0.8
    assert worst <= 1.0


@pytest.mark.parametrize("accel", ACCELERATIONS)
def test_contacts_have_the_same_bits_however_a_flight_is_searched(accel: str) -> None:
    rng = np.random.default_rng(6)
    for _ in range(60):
        gate, ball = gate_and_flight(rng, accel)
        whole = first_contact(gate, ball)
        for ticks in (60, 240, 1000):
            limits = [k / ticks for k in range(math.ceil(LIMIT * ticks))] + [LIMIT]
            assert min(first_contact(gate, ball, *span) for span in itertools.pairwise(limits)) == whole
        if whole < math.inf:
            assert first_contact(gate, ball, whole) == whole
            assert first_contact(gate, ball, 0.0, whole) == math.inf


def test_a_ball_from_above_is_blocked_at_the_exact_time() -> None:
    assert first_contact(GATE, flight(2.0, 0.0, -3.0, 0.0, 0.0)) == pytest.approx((2 - REACH) / 3, abs=1e-15)


def test_a_ball_from_below_passes() -> None:
    assert (
        first_contact(GATE, flight(-2.0, 0.3, 9.0, 0.2)) == math.inf
    )  # it is above for the rest of the time


def test_a_ball_that_passes_and_falls_back_in_the_same_flight_is_blocked() -> None:
    ball = flight(-1.0, 0.0, 6.0, 0.0)  # up to x = 0.8
    age = 0.6 + math.sqrt(2 * (0.8 - REACH) / 10)
    assert first_contact(GATE, ball) == pytest.approx(age, abs=1e-14)


def test_a_ball_that_turns_back_before_it_has_passed_meets_nothing() -> None:
    ball = flight(-1.0, 0.0, math.sqrt(20 * (1.0 + REACH - 1e-6)), 0.0)  # up to just below the outline
    assert first_contact(GATE, ball) == math.inf
    ball = flight(-1.0, 0.0, math.sqrt(20 * (1.0 + REACH + 1e-6)), 0.0)
    assert first_contact(GATE, ball) < math.inf


@pytest.mark.parametrize("x", [-0.3, 0.0, 0.2, REACH - 1e-6])
@pytest.mark.parametrize("vx", [-3.0, 0.0])
def test_a_ball_that_overlaps_from_below_falls_back_freely(x: float, vx: float) -> None:
    assert first_contact(GATE, flight(x, 0.1, vx, 0.0)) == math.inf


@pytest.mark.parametrize("offset", [-1e-9, -1e-15, 0.0])
def test_a_ball_on_the_blocked_side_stays_there(offset: float) -> None:
    for z in (-0.9, 0.0, 0.9):
        x = REACH + 0.99 * offset
        assert first_contact(GATE, flight(x, z, -1.0, 0.0)) == 0.0
        assert first_contact(GATE, flight(x, z, 0.0, 0.0)) == 0.0  # at rest, and pressed against it
        hop = first_contact(GATE, flight(x, z, 0.1, 0.0))
        assert hop == pytest.approx(0.02, abs=1e-6)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("offset", [-1e-9, -1e-15, 0.0, 1e-15, 5e-14])
def test_a_ball_on_an_end_stays_there(side: float, offset: float) -> None:
    slope = math.sqrt(0.5)
    reach = REACH + 0.99 * offset
    x, z = reach * slope, side * (1.0 + reach * slope)
    assert first_contact(GATE, flight(x, z, -1.0, 0.0)) <= 1e-13
    assert first_contact(GATE, flight(x, z, 0.0, 0.0)) <= 1e-6
    assert first_contact(GATE, flight(x, z, -1.0, side * 1.5)) > 0.01  # it leaves sideways


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_ball_from_the_side_meets_the_upper_quarter_of_an_end_only(side: float) -> None:
    for height, meets in ((0.1, True), (1e-6, True), (-1e-6, False), (-0.1, False)):
        ball = flight(height, side * 3.0, 0.0, -side * 6.0, 0.0)
        age = (2.0 - math.sqrt(REACH**2 - height**2)) / 6.0
        assert first_contact(GATE, ball) == (pytest.approx(age, abs=1e-14) if meets else math.inf)


def test_there_is_no_slit_between_the_face_and_an_end() -> None:
    edges = [side * 1.0 + k * 1e-16 for side in (-1, 1) for k in range(-8, 9)]
    for z in edges:
        for vz in (0.0, 1e-9, -1e-9, 1.0, -1.0):
            ball = flight(1.0 + REACH, z - vz * 0.25, -4.0, vz, 0.0)
            assert first_contact(GATE, ball) == pytest.approx(0.25, abs=1e-8)
