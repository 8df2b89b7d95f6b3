"""Does the plumb-bob's swing fade as a swing does?"""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from silverball.game import tilt


@given(st.floats(0.1, 10.0), st.integers(0, 5000), st.floats(100.0, 5000.0))
def test_a_swing_fades_like_e_to_the_minus_t(swing, ticks, decay):
    expected = swing * math.exp(-ticks / decay)
    # (1 − 1/d)^t is e^(−t/d − t/(2d²) − …): the relative error is about t / (2 d²)
    assert tilt.faded(swing, ticks, decay) == pytest.approx(expected, rel=ticks / decay**2 + 1e-9)


@given(st.floats(0.0, 10.0), st.integers(0, 300), st.floats(0.5, 500.0))
def test_a_swing_that_fades_tick_by_tick_gets_to_the_same_place(swing, ticks, decay):
    keeps, slow = max(1.0 - 1.0 / decay, 0.0), swing
    for _ in range(ticks):
        slow *= keeps
    assert tilt.faded(swing, ticks, decay) == pytest.approx(slow, rel=1e-12, abs=1e-300)


@pytest.mark.parametrize(
    ("swing", "warnings", "expected"),
    [
        (1.0, 0, tilt.Verdict.NOTHING),
        (1.5, 0, tilt.Verdict.NOTHING),
        (1.6, 0, tilt.Verdict.WARNING),
        (1.6, 1, tilt.Verdict.WARNING),
        (1.6, 2, tilt.Verdict.TILT),
        (2.4, 0, tilt.Verdict.WARNING),
        (2.5, 0, tilt.Verdict.TILT),
    ],
)
def test_a_shove_is_judged_by_the_swing_and_by_the_warnings_before(swing, warnings, expected):
    assert tilt.judged(swing, warnings, 1.5, 2.4, 2) is expected
