"""Arcs: distances, and the times of contacts from both sides and past the ends."""

from __future__ import annotations

import math
from typing import NamedTuple

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from mpmath import mpf

from contact_times import BOUND, exact, first_root, length
from rows_of import RADIUS, ball_at, first_touch, row_of
from silverball.physics.flight import time_to_shape
from silverball.physics.records import Shape
from silverball.physics.shapes import distance
from silverball.table.primitive import Primitive

FLIGHTS = 200
GRAVITY = 10.0
TIME = 0.25  # [s] of a flight


class Curve(NamedTuple):
    """An arc as a person writes it: ends [u], tan(angle/4), half its thickness [u]."""

    start: tuple[float, float]
    end: tuple[float, float]
    bulge: float
    thickness: float

    @property
    def primitive(self) -> Primitive:
        return Primitive(Shape.ARC, (self.start, self.end), self.thickness, bulge=self.bulge)


QUARTER = Curve((-1.0, -1.5), (1.5, 1.0), 0.41421, 0.1)
FLAT = Curve((1.0, -2.0), (0.3, 2.2), -0.002, 0.05)
HALF = Curve((0.5, -1.3), (0.5, 1.3), 1.0, 0.05)
HORSESHOE = Curve((-0.7, 0.3), (0.2, -0.6), -2.4, 0.08)
LANE = Curve((-2.0, 3.0), (3.0, -2.0), -0.8, 0.05)
CURVES = {"quarter": QUARTER, "flat": FLAT, "half": HALF, "horseshoe": HORSESHOE, "lane": LANE}


def circle_of(curve: Curve, number=float):
    """Centre, radius, direction of the middle and half angle, by the formulas of bulges."""
    (ax, az), (bx, bz) = ((number(n) for n in end) for end in (curve.start, curve.end))
    bulge = number(curve.bulge)
    dx, dz = bx - ax, bz - az
    share = (1 - bulge * bulge) / (4 * bulge)
    cx, cz = (ax + bx) / 2 + share * dz, (az + bz) / 2 - share * dx
    mx, mz = (ax + bx) / 2 - bulge * dz / 2, (az + bz) / 2 + bulge * dx / 2
    root, atan = (mpmath.sqrt, mpmath.atan) if number is exact else (math.sqrt, math.atan)
    radius = root((mx - cx) ** 2 + (mz - cz) ** 2)
    return cx, cz, radius, (mx - cx) / radius, (mz - cz) / radius, 2 * atan(abs(bulge))


def arc_gap(x, z, curve: Curve):
    """Distance of a ball's surface from the arc; for floats, arrays and mpf."""
    is_exact = isinstance(x, mpf)
    number = exact if is_exact else float
    cx, cz, radius, mx, mz, half = circle_of(curve, number)
    (ax, az), (bx, bz) = ((number(n) for n in end) for end in (curve.start, curve.end))
    qx, qz = x - cx, z - cz
    turn = (mpmath.atan2 if is_exact else np.arctan2)(qx * mz - qz * mx, qx * mx + qz * mz)
    face = abs(length(qx, qz) - radius)
    first, second = length(x - ax, z - az), length(x - bx, z - bz)
    ends = min(first, second) if is_exact else np.minimum(first, second)
    near = (face if abs(turn) <= half else ends) if is_exact else np.where(np.abs(turn) <= half, face, ends)
    return near - number(curve.thickness) - number(RADIUS)


def flight_gap(ball, curve: Curve):
    def gap(t):
        x, z, vx, vz = (exact(n) for n in ball) if isinstance(t, mpf) else ball
        return arc_gap(x + vx * t - t * t * 5, z + vz * t, curve)

    return gap


def aimed_balls(curve: Curve, seed: int, spread: float = 0.05):
    """Balls at any distance that fly at places on the arc, or `spread` [u] past its ends, from all sides."""
    rng = np.random.default_rng(seed)
    cx, cz, radius, mx, mz, half = circle_of(curve)
    while True:
        turn = rng.uniform(-half, half) if rng.random() < 0.6 else rng.choice([-1, 1]) * half
        turn += rng.normal(0, spread) / max(radius, 1)
        x = cx + radius * (math.cos(turn) * mx - math.sin(turn) * mz)
        z = cz + radius * (math.cos(turn) * mz + math.sin(turn) * mx)
        way, speed, ahead = rng.uniform(0, 2 * math.pi), rng.uniform(0.5, 21), rng.uniform(0.01, TIME)
        vx, vz = speed * math.sin(way), speed * math.cos(way)
        yield tuple(float(n) for n in (x - vx * ahead + 5 * ahead**2, z - vz * ahead, vx, vz))


def fly(ball, row):
    return first_touch(row, ball_at(*ball, accel=(-GRAVITY, 0.0)), RADIUS, TIME)


@pytest.mark.parametrize("name", CURVES)
def test_hit_times_on_arcs(name: str) -> None:
    curve = CURVES[name]
    row, gap_of, kinds = row_of(curve.primitive), flight_gap, {"inside": 0, "outside": 0, "end": 0}
    worst = 0.0
    cx, cz, radius, mx, mz, half = circle_of(curve)
    for ball in aimed_balls(curve, 5):
        gap = gap_of(ball, curve)
        with mpmath.workdps(50):
            found = first_root(gap, TIME)
            if found is None:
                continue
            root, rate = found
            time, is_hit = fly(ball, row)
            assert is_hit, f"{ball} should have met the arc after {mpmath.nstr(root, 20)} s"
            error = float(abs(time - root) * abs(rate) / BOUND)
        worst = max(worst, error)
        assert error <= 1.0, f"{ball}: {time!r}, exactly {mpmath.nstr(root, 25)}"
        qx, qz = ball[0] + ball[2] * time - 5 * time**2 - cx, ball[1] + ball[3] * time - cz
        turn = math.atan2(qx * mz - qz * mx, qx * mx + qz * mz)
        kind = "end" if abs(turn) > half else "inside" if math.hypot(qx, qz) < radius else "outside"
        kinds[kind] += 1
        if min(kinds.values()) >= 20 and sum(kinds.values()) >= FLIGHTS:
            break
    print(f"{name}: worst {worst:.3f} of 8·ulp(10)/|D′| in {kinds}")


@pytest.mark.parametrize("name", CURVES)
def test_no_flight_passes_through_an_arc_and_none_is_stopped_in_the_air(name: str) -> None:
    """2,000 flights each, against dense sampling."""
    curve = CURVES[name]
    row, balls = row_of(curve.primitive), aimed_balls(curve, 6, 1.5)
    times = np.linspace(0.0, TIME, 3000)
    hits = misses = 0
    while hits + misses < 2000:
        ball = next(balls)
        gaps = flight_gap(ball, curve)(times)
        if gaps[0] < 1e-9:
            continue
        time, is_hit = fly(ball, row)
        below = np.flatnonzero(gaps < -1e-9)
        if below.size:
            assert is_hit, ball
            assert time <= times[below[0]]
        if is_hit:
            hits += 1
            assert abs(flight_gap(ball, curve)(np.array([time]))[0]) < 1e-9, ball
            assert (gaps[times < time] > -1e-9).all()
        else:
            misses += 1
    assert min(hits, misses) > 100


@pytest.mark.parametrize("name", CURVES)
def test_the_distance_from_an_arc_is_that_from_many_of_its_points(name: str) -> None:
    curve = CURVES[name]
    row = row_of(curve.primitive)
    cx, cz, radius, mx, mz, half = circle_of(curve)
    turns = np.linspace(-half, half, 20001)
    xs = cx + radius * (np.cos(turns) * mx - np.sin(turns) * mz)
    zs = cz + radius * (np.cos(turns) * mz + np.sin(turns) * mx)
    rng = np.random.default_rng(7)
    for _ in range(300):
        x, z = rng.uniform(-5, 5, 2)
        away = np.hypot(x - xs, z - zs)
        gap, nx, nz = distance(row, x, z)
        near, step = away.min(), 2 * half * radius / 20000
        assert gap + curve.thickness == pytest.approx(near, abs=min(step, step**2 / max(near, 1e-9)) + 1e-12)
        if near > 0.01:
            k = away.argmin()
            assert (nx, nz) == pytest.approx(((x - xs[k]) / near, (z - zs[k]) / near), abs=2 * step / near)


def test_the_centre_of_an_arc_has_a_distance_and_a_normal() -> None:
    row = row_of(HALF.primitive)
    cx, cz, radius, mx, mz, _ = circle_of(HALF)
    assert distance(row, cx, cz) == pytest.approx((radius - 0.05, -mx, -mz))


arcs = st.builds(
    lambda length, turn, bulge, thickness: Curve(
        (0.0, 0.0), (length * math.sin(turn), length * math.cos(turn)), bulge, thickness
    ),
    st.floats(0.05, 5.0),
    st.floats(0.0, 2 * math.pi),
    st.one_of(st.floats(1e-3, 5.0), st.floats(-5.0, -1e-3)),
    st.floats(0.0, 0.3),
)
motions = st.tuples(st.floats(-4, 4), st.floats(-4, 4), st.floats(-15, 15), st.floats(-15, 15))


@settings(max_examples=400, deadline=None)
@given(arcs, motions)
def test_a_ball_is_never_deep_in_an_arc_before_its_contact(curve: Curve, motion) -> None:
    gap = flight_gap(motion, curve)
    row, start = row_of(curve.primitive), gap(np.array([0.0]))[0]
    if start < 1e-9:
        return
    time, is_hit = fly(motion, row)
    times = np.linspace(0.0, time if is_hit else TIME, 500)
    assert gap(times).min() > -2e-9
    if is_hit:
        assert abs(gap(times[-1:])[0]) < 2e-9


@settings(max_examples=200, deadline=None)
@given(arcs, motions)
def test_a_mirrored_arc_is_met_at_the_same_time_bit_for_bit(curve: Curve, motion) -> None:
    (ax, az), (bx, bz) = curve.start, curve.end
    mirrored = Curve((ax, -az), (bx, -bz), -curve.bulge, curve.thickness)
    x, z, vx, vz = motion
    if flight_gap(motion, curve)(np.array([0.0]))[0] < 0.0:
        return
    assert fly((x, z, vx, vz), row_of(curve.primitive)) == fly((x, -z, vx, -vz), row_of(mirrored.primitive))


def test_a_ball_that_rests_on_an_arc_touches_it_at_once() -> None:
    bowl = row_of(Curve((0.0, -2.0), (0.0, 2.0), 1.0, 0.05).primitive)  # its lowest place is at x = −2
    hill = row_of(Curve((0.0, -2.0), (0.0, 2.0), -1.0, 0.05).primitive)
    for row, x in ((bowl, -2.0 + 0.05 + RADIUS), (hill, 2.0 + 0.05 + RADIUS)):
        assert distance(row, x, 0.0)[0] == pytest.approx(RADIUS, abs=1e-12)
        time, is_hit = fly((x, 0.0, 0.0, 0.0), row)
        assert is_hit
        assert time < 1e-7  # from a rounding of 4e-16 u it falls for 9e-9 s


def test_a_ball_that_is_pressed_to_an_arc_never_sinks() -> None:
    """A ball at rest, pressed to either side or to an end, touches it before it has moved."""
    bowl, cap = Curve((0.0, -2.0), (0.0, 2.0), 1.0, 0.0), Curve((0.0, -2.0), (0.0, 2.0), -1.0, 0.0)
    for curve, x, z in ((bowl, -2.0 + RADIUS, 0.0), (cap, 2.0 + RADIUS, 0.0), (bowl, RADIUS, 2.0)):
        row = row_of(curve.primitive)
        for depth in (0.0, 1e-12):
            assert fly((x - depth, z, 0.0, 0.0), row) == (0.0, True)
        time, is_hit = fly((x, z, -1e-3, 0.0), row)  # it comes
        assert (time, is_hit) == (0.0, True)
        time, is_hit = fly((x, z, 1e-3, 0.0), row)  # it hops
        assert is_hit
        assert pytest.approx(time, rel=1e-6) == 2e-3 / GRAVITY


def test_a_ball_on_both_ends_of_a_cup_bounces_off_each() -> None:
    """The cup is too narrow for the ball, which lies on both of its ends: neither may hide the other."""
    row = row_of(Curve((0.0, -0.2), (0.0, 0.2), 1.0, 0.0).primitive)
    x = math.sqrt(RADIUS**2 - 0.2**2)
    for vz in (3.0, -3.0):
        time, is_hit = fly((x, 0.0, 0.0, vz), row)
        assert is_hit
        assert time < 1e-9


@settings(max_examples=1000)
@given(
    st.floats(1e-4, 4.0), st.integers(-32, 32), st.integers(-32, 32), st.sampled_from([0.0, 1e-6, 0.3, 9.0]),
    st.sampled_from([-1e-12, -1e-16, 0.0, 1e-16, 1e-9]), st.booleans(),
)  # fmt: skip
def test_a_search_that_finds_nothing_has_got_on(room, turn, way, speed, gap, is_inside) -> None:
    """Also for a ball in an arc hardly larger than itself, which it is about to leave or pressed to."""
    thickness, turn, way = 0.05, turn / 10, way / 10
    radius = RADIUS + thickness + room if is_inside else room
    row = row_of(Curve((0.0, -radius), (0.0, radius), -1.0, thickness).primitive)
    out = radius - thickness - RADIUS - gap if is_inside else radius + thickness + RADIUS + gap
    x, z = out * math.cos(turn), out * math.sin(turn)
    along = (-speed * math.sin(turn), speed * math.cos(turn))  # a ball that slides along the arc
    ball = ball_at(x, z, *along, accel=(10.0 * math.cos(way), 10.0 * math.sin(way)))
    time, is_hit = time_to_shape(row, ball, RADIUS, 0.0, TIME)
    assert is_hit or time > 0.0
