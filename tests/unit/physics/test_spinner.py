"""The blades of spinners against 50 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from silverball.physics.spinner import (
    blade_angle,
    blade_speed,
    remaining_turns,
    slowed_by_blade,
    time_of_turn,
)

DAMPING = (0.0, 1e-9, 1e-3, 0.1, 2.0, 30.0)  # [1/s]
TIME_BOUND = 1e-12  # [s]


def random_blade(rng) -> tuple[float, float, float]:
    """Angle, speed of either sign and damping."""
    speed = float(rng.choice([-1, 1]) * rng.uniform(0.5, 100.0))
    return float(rng.uniform(-math.pi, math.pi)), speed, float(rng.choice(DAMPING))


def exact_decay(damping: float, elapsed):
    k = mpf(damping)
    return -mpmath.expm1(-k * elapsed) / k if damping else mpf(elapsed)


def exact_turn(angle: float, speed: float, damping: float, number: int):
    """The time of a turn, and the speed then; None if it is not made."""
    ahead = (2 * number - 1) * mpmath.pi - mpf(angle) * (1 if speed > 0 else -1)
    share = mpf(damping) * ahead / abs(mpf(speed))
    if share >= 1:
        return None
    time = -mpmath.log1p(-share) / mpf(damping) if damping else ahead / abs(mpf(speed))
    return time, abs(mpf(speed)) * (1 - share)


def test_turns_take_place_at_their_exact_times() -> None:
    rng = np.random.default_rng(7)
    worst, count = 0.0, 0
    with mpmath.workdps(50):
        for _ in range(2000):
            blade = random_blade(rng)
            number = int(rng.integers(1, 12))
            exact, found = exact_turn(*blade, number), time_of_turn(*blade, number)
            if exact is None:
                assert found == math.inf
                continue
            # An angle is known to some ulp of the way; a blade that has nearly stopped takes long for that.
            bound = TIME_BOUND + 4 * math.ulp(2 * math.pi * number) / float(exact[1])
            worst = max(worst, float(abs(found - exact[0])) / bound)
            count += found < math.inf
    print(f"turns: worst {worst:.3f} of the bound in {count}")
    assert count > 1000
    assert worst <= 1.0


def test_angle_and_speed_follow_from_the_damping() -> None:
    rng = np.random.default_rng(8)
    with mpmath.workdps(50):
        for _ in range(2000):
            angle, speed, damping = random_blade(rng)
            elapsed = float(rng.uniform(0.0, 3.0))
            left = mpf(speed) * mpmath.exp(-mpf(damping) * mpf(elapsed))
            assert abs(blade_speed(speed, damping, elapsed) - left) <= 1e-13 * abs(speed)
            way = mpf(angle) + mpf(speed) * exact_decay(damping, mpf(elapsed))
            turns = int(mpmath.floor((abs(mpf(speed)) / speed * way + mpmath.pi) / (2 * mpmath.pi)))
            inside = way - (2 if speed > 0 else -2) * turns * mpmath.pi
            found = blade_angle(angle, speed, damping, elapsed, turns)
            assert abs(found - inside) <= 1e-12
            assert abs(found) <= math.pi


def test_a_turn_is_counted_once_when_a_ball_passes_at_its_very_time() -> None:
    """The angle after the n-th turn is on the far side of the top, up to then on the near side, whatever the
    rounding; so after another crossing in the same direction the next turn is a whole one away or due."""
    rng = np.random.default_rng(9)
    for _ in range(500):
        angle, speed, damping = random_blade(rng)
        number = int(rng.integers(1, 4))
        time = time_of_turn(angle, speed, damping, number)
        if time == math.inf:
            continue
        sign = math.copysign(1.0, speed)
        after = blade_angle(angle, speed, damping, time, number)
        assert sign * after == pytest.approx(-math.pi, abs=1e-11)
        assert time_of_turn(after, sign * 10.0, 0.0, 1) == pytest.approx(2 * math.pi / 10.0, abs=1e-11)
        before = blade_angle(angle, speed, damping, time, number - 1)
        assert sign * before == pytest.approx(math.pi, abs=1e-11)
        assert 0.0 <= time_of_turn(before, sign * 10.0, 0.0, 1) <= 1e-11


def test_the_remaining_turns_are_those_that_have_a_time() -> None:
    rng = np.random.default_rng(10)
    most = 0
    for _ in range(2000):
        angle, speed, _ = random_blade(rng)
        damping = float(rng.choice([0.1, 2.0, 30.0]))
        if rng.random() < 0.2:  # the last turn is made just so, or just not
            angle, speed = 0.0, damping * math.pi * (2 * int(rng.integers(1, 6)) - 1)
            speed = math.nextafter(speed, float(rng.choice([0.0, speed, math.inf])))
        total = remaining_turns(angle, speed, damping, 0)
        assert time_of_turn(angle, speed, damping, max(total, 1)) < math.inf or total == 0
        assert time_of_turn(angle, speed, damping, total + 1) == math.inf
        assert remaining_turns(angle, speed, damping, 1) == max(total - 1, 0)
        most = max(most, total)
    assert most > 50


def test_a_blade_at_rest_makes_no_turn() -> None:
    assert time_of_turn(0.0, 0.0, 1.0, 1) == math.inf
    assert remaining_turns(0.0, 0.0, 1.0, 0) == 0
    assert blade_angle(0.5, 0.0, 1.0, 9.0, 0) == 0.5


def test_a_blade_mirrors_its_turns() -> None:
    assert time_of_turn(0.4, 20.0, 0.7, 3) == time_of_turn(-0.4, -20.0, 0.7, 3)
    assert blade_angle(0.4, 20.0, 0.7, 1.1, 2) == -blade_angle(-0.4, -20.0, 0.7, 1.1, 2)


def test_a_blade_takes_speed_from_the_ball() -> None:
    assert slowed_by_blade(3.0, -4.0, 0.0) == (3.0, -4.0)
    vx, vz = slowed_by_blade(3.0, -4.0, 1.0)
    assert (vx, vz) == (pytest.approx(2.4, abs=1e-15), pytest.approx(-3.2, abs=1e-15))
    assert slowed_by_blade(3.0, -4.0, 5.0) == (0.0, 0.0)
    assert slowed_by_blade(0.0, 0.0, 0.0) == (0.0, 0.0)
