"""The portable sine and cosine against 40 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from silverball.physics.portable_math import sine_cosine


def arguments() -> list[float]:
    rng = np.random.default_rng(20)
    quarters = [k * math.pi / 4 for k in range(-40, 41)]
    near = [math.nextafter(q, side) for q in quarters for side in (-math.inf, math.inf)]
    tiny = [sign * 2.0**-n for n in range(1, 1000, 7) for sign in (-1, 1)]
    far = [k * math.pi / 2 for k in range(1, 6366, 13)]  # where the reduction loses most
    return [
        0.0, 1e4, -1e4, *quarters, *near, *tiny, *far,
        *rng.uniform(-10, 10, 15_000).tolist(), *rng.uniform(-1e4, 1e4, 5_000).tolist(),
    ]  # fmt: skip


def test_sine_and_cosine_are_within_one_unit_in_the_last_place() -> None:
    values = arguments()
    assert len(values) >= 20_000
    worst = 0.0
    with mpmath.workdps(40):
        for x in values:
            for got, exact in zip(sine_cosine(x), mpmath.cos_sin(x)[::-1], strict=True):
                if exact != 0:
                    worst = max(worst, float(abs(got - exact)) / math.ulp(float(exact)))
    print(f"sine and cosine: worst error {worst:.3f} ulp of {len(values)} arguments")
    assert worst <= 1.0


@pytest.mark.parametrize("x", [0.1, 0.7, 1.2, 3.0, 44.4])
def test_sine_is_odd_and_cosine_even_to_the_bit(x: float) -> None:
    sine, cosine = sine_cosine(x)
    assert sine_cosine(-x) == (-sine, cosine)


def test_at_zero_they_are_exact() -> None:
    assert sine_cosine(0.0) == (0.0, 1.0)
