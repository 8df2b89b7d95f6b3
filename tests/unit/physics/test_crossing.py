"""The times at which flights cross lines and enter discs, against 50 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from flights import (
    TIME_BOUND,
    all_found,
    disc,
    exact_disc_entries,
    exact_path,
    flight,
    random_flight,
    real_roots,
    segment,
)
from silverball.physics.crossing import disc_entry, line_crossing

FLIGHTS = 400
LIMIT = 1.5  # [s]
ACCELERATIONS = ("gravity", "any", "none")


def searched(find, row, ball, limits=(LIMIT,)):
    return all_found(lambda start, is_past, limit: find(row, ball, start, is_past, limit), limits)


def line_and_flight(rng, accel: str):
    """The ends of a line, and a flight that passes near it."""
    start, end = rng.uniform(-1.5, 1.5, (2, 2))
    shares = rng.uniform(-0.1, 1.1, (2, 1))
    return (start.tolist(), end.tolist()), random_flight(rng, accel, start + shares * (end - start))


def disc_and_flight(rng, accel: str):
    """Centre and radius of a disc, and a flight that passes near it."""
    center, radius = rng.uniform(-1.0, 1.0, 2), float(rng.choice([0.05, 0.2, 0.7]))
    return (*center.tolist(), radius), random_flight(
        rng, accel, center + rng.normal(0.0, 0.6 * radius, (2, 2))
    )


def exact_line_crossings(ball, start, end):
    """All crossings of a segment by a flight: age, direction and speed; None when in doubt."""
    position, velocity = exact_path(ball, *start)
    dx, dz = mpf(end[0]) - mpf(start[0]), mpf(end[1]) - mpf(start[1])
    length = mpmath.sqrt(dx * dx + dz * dz)

    def height(point):
        return (point[0] * dz - point[1] * dx) / length

    gap, rate = height(position(mpf(0))), height(velocity(mpf(0)))
    accel = height(velocity(mpf(1))) - rate
    found = []
    if abs(gap) < 1e-6:
        return None
    for t in real_roots([gap, rate, accel / 2]):
        point = position(t)
        share = (point[0] * dx + point[1] * dz) / length**2
        speed = rate + accel * t
        if t > 0 and (min(abs(share), abs(share - 1)) < 1e-9 or abs(speed) < 1e-4):
            return None
        if 0 < t < LIMIT and 0 < share < 1:
            found.append((t, 1 if speed > 0 else -1, speed))
    return found


@pytest.mark.parametrize("accel", ACCELERATIONS)
def test_all_crossings_of_a_line_with_their_directions(accel: str) -> None:
    rng = np.random.default_rng(1)
    worst, counts = 0.0, [0, 0, 0]
    with mpmath.workdps(50):
        for _ in range(FLIGHTS):
            (start, end), ball = line_and_flight(rng, accel)
            exact = exact_line_crossings(ball, start, end)
            if exact is None:
                continue
            found = searched(line_crossing, segment(start, end), ball)
            assert [direction for _, direction in found] == [direction for _, direction, _ in exact]
            counts[len(exact)] += 1
            for (age, _), (t, _, speed) in zip(found, exact, strict=True):
                worst = max(worst, float(abs(age - t) * abs(speed)) / TIME_BOUND)
    print(f"lines, {accel}: worst {worst:.3f} of 8·ulp(10)/speed; flights by crossings {counts}")
    assert counts[1] > 50
    assert counts[2] > 20 or accel == "none"
    assert worst <= 1.0


@pytest.mark.parametrize("accel", ACCELERATIONS)
def test_all_entries_into_a_disc(accel: str) -> None:
    rng = np.random.default_rng(2)
    worst, counts = 0.0, [0, 0, 0]
    with mpmath.workdps(50):
        for _ in range(FLIGHTS):
            (x, z, radius), ball = disc_and_flight(rng, accel)
            exact = exact_disc_entries(ball, x, z, radius)
            if any(abs(rate) < 1e-4 for _, rate in exact):
                continue
            exact = [entry for entry in exact if entry[0] < LIMIT]
            found = searched(disc_entry, disc(x, z, radius), ball)
            assert len(found) == len(exact), (ball, x, z, radius)
            counts[len(exact)] += 1
            for (age, _), (t, rate) in zip(found, exact, strict=True):
                worst = max(worst, float(abs(age - t) * abs(rate)) / TIME_BOUND)
    print(f"discs, {accel}: worst {worst:.3f} of 8·ulp(10)/rate; flights by entries {counts}")
    assert counts[1] > 50
    assert counts[2] > 20 or accel == "none"
    assert worst <= 1.0


@pytest.mark.parametrize("find", [line_crossing, disc_entry])
def test_crossings_have_the_same_bits_however_a_flight_is_searched(find) -> None:
    rng = np.random.default_rng(3)
    crossed = 0
    for _ in range(100):
        accel = str(rng.choice(ACCELERATIONS))
        if find is line_crossing:
            ends, ball = line_and_flight(rng, accel)
            row = segment(*ends)
        else:
            circle, ball = disc_and_flight(rng, accel)
            row = disc(*circle)
        found = searched(find, row, ball)
        crossed += len(found)
        for ticks in (60, 240, 1000):
            limits = [k / ticks for k in range(1, math.ceil(LIMIT * ticks))] + [LIMIT]
            assert searched(find, row, ball, limits) == found
        # Searches that end at the crossings, and just before and after them.
        near = [
            math.nextafter(age, to) if to is not None else age
            for age, *_ in found
            for to in (-1.0, None, 9.0)
        ]
        assert searched(find, row, ball, [*sorted(near), LIMIT]) == found
    assert crossed > 60


def test_the_left_of_a_line_is_the_left_as_the_player_sees_it() -> None:
    upwards = segment((0.0, 0.0), (1.0, 0.0))
    assert line_crossing(upwards, flight(0.5, 1.0, 0.0, -10.0, 0.0), 0.0, False, 1.0) == (0.1, 1)
    assert line_crossing(upwards, flight(0.5, -1.0, 0.0, 10.0, 0.0), 0.0, False, 1.0) == (0.1, -1)


@pytest.mark.parametrize("offset", [-1e-9, -1e-10, -1e-15, 0.0, 1e-15, 1e-10, 1e-9])
@pytest.mark.parametrize("direction", [-1, 1])
def test_a_flight_that_starts_on_a_line_has_crossed_it(offset: float, direction: int) -> None:
    line = segment((0.0, -1.0), (0.0, 1.0))  # to the right; its left is up
    away = flight(0.99 * offset, 0.0, direction * 2.0, 0.3)
    back = [(pytest.approx(0.4, abs=1e-8), -1)]
    assert searched(line_crossing, line, away) == (back if direction > 0 else [])
    assert searched(line_crossing, line, flight(0.99 * offset, 0.0, 0.0, 0.3)) == []


def test_a_flight_that_starts_outside_the_tolerance_crosses() -> None:
    line = segment((0.0, -1.0), (0.0, 1.0))
    ((age, direction),) = searched(line_crossing, line, flight(1.01e-9, 0.0, -2.0, 0.0))
    assert (age, direction) == (pytest.approx(1.01e-9 / 2.0, rel=1e-6), -1)


def test_a_line_is_crossed_between_its_ends_only() -> None:
    line = segment((0.0, -1.0), (0.0, 1.0))
    for z, count in ((-1.0 - 1e-12, 0), (-1.0, 1), (1.0, 1), (1.0 + 1e-12, 0)):
        assert len(searched(line_crossing, line, flight(1.0, z, -5.0, 0.0))) == count


def test_a_flight_that_touches_a_line_does_not_cross_it() -> None:
    line = segment((0.45, -1.0), (0.45, 1.0))
    assert searched(line_crossing, line, flight(0.0, 0.0, 3.0, 0.0)) == []  # its apex
    above = segment((0.45 - 1e-12, -1.0), (0.45 - 1e-12, 1.0))
    assert [direction for _, direction in searched(line_crossing, above, flight(0.0, 0.0, 3.0, 0.0))] == [
        1,
        -1,
    ]


def test_a_ball_that_starts_in_a_disc_enters_it_only_after_it_has_left() -> None:
    hole = disc(0.0, 0.0, 0.5)
    up = flight(0.0, 0.0, 5.0, 0.0)
    assert searched(disc_entry, hole, up) == [(pytest.approx(0.5 + math.sqrt(0.15), abs=1e-14), True)]
    assert searched(disc_entry, hole, flight(0.0, 0.0, 3.0, 0.0)) == []  # it stays inside up to its apex


@pytest.mark.parametrize("offset", [-1e-9, -1e-15, 0.0, 1e-15, 1e-9])
def test_a_ball_that_starts_on_the_edge_of_a_disc_has_entered_it(offset: float) -> None:
    hole = disc(0.0, 0.0, 0.5)
    assert searched(disc_entry, hole, flight(0.5 + 0.99 * offset, 0.0, -2.0, 0.0)) == []
    out = searched(disc_entry, hole, flight(0.5 + 0.99 * offset, 0.0, 2.0, 0.0))
    assert out == [(pytest.approx(0.4, abs=1e-8), True)]


def test_a_ball_outside_the_tolerance_enters() -> None:
    ((age, _),) = searched(disc_entry, disc(0.0, 0.0, 0.5), flight(0.5 + 1.01e-9, 0.0, -2.0, 0.0))
    assert age == pytest.approx(1.01e-9 / 2.0, rel=1e-6)


def test_balls_at_rest_cross_nothing() -> None:
    ball = flight(0.5, 0.0, 0.0, 0.0, 0.0)
    assert searched(disc_entry, disc(0.0, 0.0, 0.4), ball) == []
    assert searched(line_crossing, segment((0.0, -1.0), (0.0, 1.0)), ball) == []


def test_a_slow_ball_without_gravity_enters_a_disc_after_hours() -> None:
    ball = flight(1.0, 0.0, -1e-5, 0.0, 0.0)
    assert disc_entry(disc(0.0, 0.0, 0.5), ball, 0.0, False, 1e6) == (pytest.approx(5e4, rel=1e-14), True)
