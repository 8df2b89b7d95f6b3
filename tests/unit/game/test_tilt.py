"""The tilt bob swings, decays and tilts as its definition says."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, strategies as st

from silverball.referee import tilt


@given(st.floats(0.1, 10.0), st.integers(0, 5000), st.floats(100.0, 5000.0))
def test_a_swing_decays_like_e_to_the_minus_t(swing, ticks, decay):
    expected = swing * math.exp(-ticks / decay)
    # (1 − 1/d)^t is e^(−t/d − t/(2d²) − …): the relative error is about t / (2 d²)
    assert tilt.decayed(swing, ticks, decay) == pytest.approx(expected, rel=ticks / decay**2 + 1e-9)


@given(st.floats(0.0, 10.0), st.integers(0, 300), st.floats(0.5, 500.0))
def test_decaying_tick_by_tick_gives_the_same_swing(swing, ticks, decay):
    factor, slow = max(1.0 - 1.0 / decay, 0.0), swing
    for _ in range(ticks):
        slow *= factor
    assert tilt.decayed(swing, ticks, decay) == pytest.approx(slow, rel=1e-12, abs=1e-300)


@pytest.mark.parametrize(
    ("swing", "warnings", "expected"),
    [
        (1.0, 0, tilt.ShoveResult.NOTHING),
        (1.5, 0, tilt.ShoveResult.NOTHING),
        (1.6, 0, tilt.ShoveResult.WARNING),
        (1.6, 1, tilt.ShoveResult.WARNING),
        (1.6, 2, tilt.ShoveResult.TILT),
        (2.4, 0, tilt.ShoveResult.WARNING),
        (2.5, 0, tilt.ShoveResult.TILT),
    ],
)
def test_the_result_of_a_shove_depends_on_the_swing_and_on_the_warnings_before(swing, warnings, expected):
    assert tilt.shove_result(swing, warnings, 1.5, 2.4, 2) is expected
