"""What holes capture, how they eject, and how plungers launch."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from silverball.physics.holes import can_capture, exit_velocity, launch_speed
from silverball.physics.portable_math import uniform


def test_a_hole_captures_up_to_its_speed() -> None:
    for speed in (0.5, 4.0, 21.9):
        for turn in np.linspace(0.0, 6.0, 50):
            vx, vz = speed * math.sin(turn), speed * math.cos(turn)
            assert can_capture(vx, vz, speed + 1e-9)
            assert not can_capture(vx, vz, speed - 1e-9)
    assert can_capture(3.0, 4.0, 5.0)
    assert can_capture(0.0, 0.0, 0.0)


def test_an_exit_without_spread_keeps_its_bits_and_draws_nothing() -> None:
    assert exit_velocity(0.1, -0.7, 0.0, 5, 17) == (0.1, -0.7, 17)


def test_an_exit_turns_by_the_drawn_angle() -> None:
    with mpmath.workdps(50):
        for draws in range(500):
            vx, vz, after = exit_velocity(-12.0, 5.0, 0.2, 99, draws)
            assert after == draws + 1
            angle = mpf(0.2) * (2 * mpf(uniform(99, draws)) - 1)
            cosine, sine = mpmath.cos(angle), mpmath.sin(angle)
            assert abs(vx - (-12 * cosine + 5 * sine)) <= 1e-14
            assert abs(vz - (5 * cosine + 12 * sine)) <= 1e-14


def test_exits_fill_the_spread_evenly() -> None:
    angles = []
    for draws in range(4000):
        vx, vz, _ = exit_velocity(10.0, 0.0, 0.1, 3, draws)
        angles.append(math.atan2(vz, vx))
    # The mean of n uniform numbers in ±s has the standard deviation s/√(3n); five of them.
    assert abs(np.mean(angles)) < 5 * 0.1 / math.sqrt(3 * 4000)
    assert 0.0995 < max(angles) <= 0.1 + 1e-15
    assert -0.1 - 1e-15 <= min(angles) < -0.0995


@pytest.mark.parametrize("rate", [60, 240, 1000])
def test_a_plunger_charges_linearly_at_any_tick_rate(rate: int) -> None:
    tick = 1.0 / rate
    for tenths in range(16):
        held = tenths * rate // 10
        share = min(1.0, held / rate / 0.8)
        assert launch_speed(3.0, 19.0, 0.8, held, tick) == pytest.approx(3.0 + 16.0 * share, abs=1e-13)
    assert launch_speed(3.0, 19.0, 0.8, 0, tick) == 3.0
    assert launch_speed(3.0, 19.0, 0.8, rate, tick) == 19.0


def test_a_plunger_without_charge_always_launches_at_full_speed() -> None:
    assert launch_speed(3.0, 19.0, 0.0, 0, 1 / 240) == 19.0
