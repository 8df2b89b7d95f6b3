"""The time of a first contact to 50 digits, from a gap as a function of time.

The reference brackets the first contact by sampling the flight finely, and then finds the root of the true
distance. A flight that nearly touches something before is left out: there the sampling, not the solver, would
be in doubt.

The bound: coordinates reach 10 u, where a distance is known to some ulp(10); divided by the approach speed
that is a time.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
from mpmath import mpf

SAMPLES = 1500
BOUND = 8 * math.ulp(10.0)

Gap = Callable[[Any], Any]
"""The gap [u] between ball and part as a function of time, for floats, arrays and mpf alike."""


def root_of(x):
    return mpmath.sqrt(x) if isinstance(x, mpf) else np.sqrt(x)


def length(x, z):
    return root_of(x * x + z * z)


def clamped(x):
    if isinstance(x, mpf):
        return min(max(x, mpf(0)), mpf(1))
    return np.clip(x, 0.0, 1.0)


def exact(number):
    return mpf(number)


def from_segment(x, z, p, q):
    """Distance of a point from a segment; p and q may move with time."""
    wx, wz = q[0] - p[0], q[1] - p[1]
    share = clamped(((x - p[0]) * wx + (z - p[1]) * wz) / (wx * wx + wz * wz))
    return length(x - p[0] - share * wx, z - p[1] - share * wz)


def first_root(gap: Gap, end: float) -> tuple[mpf, mpf] | None:
    """The first time at which the gap is used up, and the speed at which it is; None when that is none, or
    in doubt."""
    times = np.linspace(0.0, end, SAMPLES)
    gaps = gap(times)
    below = np.flatnonzero(gaps < 0.0)
    last = below[0] if below.size else SAMPLES
    dips = (gaps[1:-1] < gaps[:-2]) & (gaps[1:-1] < gaps[2:])
    if gaps[0] < 1e-3 or (np.flatnonzero(dips & (gaps[1:-1] < 1e-3)) + 1 < last).any() or last == SAMPLES:
        return None
    finer = np.linspace(times[last - 1], times[last], SAMPLES)
    below = int(np.flatnonzero(gap(finer) < 0.0)[0])
    # Secants from two points 1e-7 s around the root: each takes the digits of both before it together.
    t, before = exact(finer[below]), exact(finer[below - 1])
    here, there = gap(t), gap(before)
    while abs(here) > mpf(10) ** -45:
        rate = (here - there) / (t - before)
        t, before, there = t - here / rate, t, here
        here = gap(t)
    assert finer[below - 1] <= t <= finer[below]
    return t, rate
