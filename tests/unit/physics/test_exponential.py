"""The portable exponential and logarithm against 50 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from silverball.physics.portable_math import exp, expm1, log, log1p

MOST_ULPS = 2.0
TINY = [sign * 2.0**-n for n in range(1, 1022, 7) for sign in (-1, 1)]
RNG = np.random.default_rng(21)


def worst_error(function, reference, values) -> float:
    """The greatest error in units in the last place of the exact value."""
    worst, which = 0.0, 0.0
    with mpmath.workdps(50):
        for x in values:
            exact = reference(mpmath.mpf(x))
            error = float(abs(function(x) - exact)) / math.ulp(float(exact))
            if error > worst:
                worst, which = error, x
    print(f"{function.py_func.__name__}: worst error {worst:.3f} ulp, at {which!r}")
    return worst


def near(values) -> list[float]:
    """These numbers and their neighbours."""
    return [x for v in values for x in (math.nextafter(v, -math.inf), v, math.nextafter(v, math.inf))]


HALVES = near([(k + 0.5) * math.log(2.0) for k in range(-50, 51)])  # where the reduction changes


def test_the_exponential_is_within_two_units_in_the_last_place() -> None:
    values = [0.0, 709.782712893384, -708.0, *TINY, *HALVES]
    values += [*RNG.uniform(-1, 1, 5000).tolist(), *RNG.uniform(-708, 709.7, 5000).tolist()]
    assert worst_error(exp, mpmath.exp, values) <= MOST_ULPS


def test_a_subnormal_exponential_is_within_its_last_place() -> None:
    values = [*RNG.uniform(-746, -708, 500).tolist(), *near([-745.1332191019412, -745.2])]
    assert worst_error(exp, mpmath.exp, values) <= MOST_ULPS


def test_the_exponential_minus_one_is_within_two_units_in_the_last_place() -> None:
    values = [709.782712893384, -40.0, math.nextafter(-40.0, -math.inf), -1e300, *TINY, *HALVES]
    values += [*RNG.uniform(-1, 1, 5000).tolist(), *RNG.uniform(-50, 60, 5000).tolist()]
    assert worst_error(expm1, mpmath.expm1, values) <= MOST_ULPS


def test_the_logarithm_is_within_two_units_in_the_last_place() -> None:
    values = [*near([2.0**k * math.sqrt(0.5) for k in range(-50, 51)]), 5e-324, 1e-310, 1.7e308]
    values += [*np.exp(RNG.uniform(-700, 700, 5000)).tolist(), *RNG.uniform(0.5, 2, 5000).tolist()]
    values += [1.0 + t for t in TINY if 1.0 + t not in (0.0, 1.0)]
    assert worst_error(log, mpmath.log, values) <= MOST_ULPS


def test_the_logarithm_of_one_plus_a_number_is_within_two_units_in_the_last_place() -> None:
    values = [*TINY, math.nextafter(-1.0, 0.0), 1e300, *near([math.sqrt(0.5) - 1, math.sqrt(2) - 1, 1.0])]
    values += [*RNG.uniform(-1, 1, 5000).tolist(), *(10.0 ** RNG.uniform(-18, 18, 5000)).tolist()]
    values += (-(10.0 ** RNG.uniform(-18, 0, 5000))).tolist()
    assert worst_error(log1p, mpmath.log1p, values) <= MOST_ULPS


@pytest.mark.parametrize(
    ("function", "x", "y"),
    [(exp, 0.0, 1.0), (expm1, 0.0, 0.0), (log, 1.0, 0.0), (log1p, 0.0, 0.0)]
    + [(f, x, y) for f in (exp, expm1) for x, y in ((709.79, math.inf), (1e300, math.inf))]
    + [(exp, -746.0, 0.0), (exp, -1e300, 0.0), (expm1, -1e300, -1.0)],
)
def test_values_at_the_ends_of_the_range_are_exact(function, x: float, y: float) -> None:
    assert function(x) == y
