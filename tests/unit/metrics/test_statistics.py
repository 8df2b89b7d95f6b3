"""Estimates: their intervals hold the truth as often as they say, and are right at the edges."""

from __future__ import annotations

import math

import numpy as np
import pytest

from silverball.metrics.statistics import NORMAL_95, interquartile_mean, mean, median_life, ratio, share


def test_a_ratio_of_cases_that_are_all_alike_is_certain() -> None:
    assert ratio([2.0, 4.0, 6.0], [1, 2, 3]) == (2.0, 2.0, 2.0)
    assert all(math.isnan(part) for part in ratio([1.0], [0]))


def test_the_interval_of_a_ratio_holds_the_true_one_in_19_of_20_cases() -> None:
    rng = np.random.default_rng(0)
    held, cases, games = 0, 400, 200
    for _ in range(cases):
        minutes = rng.exponential(2.0, games)
        points = rng.poisson(30.0 * minutes)  # 30 a minute
        found = ratio(points, minutes)
        held += found.low < 30.0 < found.high
    # 380 are expected; five standard deviations of the binomial below and above.
    assert abs(held - 0.95 * cases) < 5.0 * math.sqrt(cases * 0.95 * 0.05)


def test_the_interval_of_a_share_stays_within_0_and_1_and_is_not_empty_for_rare_cases() -> None:
    none, half, every = share(0, 1000), share(500, 1000), share(1000, 1000)
    assert none.value == none.low == 0.0
    assert none.high == pytest.approx(NORMAL_95**2 / (1000 + NORMAL_95**2))  # Wilson's at k = 0
    assert every.low == pytest.approx(1.0 - none.high)
    assert half.high - 0.5 == pytest.approx(0.5 - half.low)
    assert half.high - 0.5 == pytest.approx(NORMAL_95 * math.sqrt(0.25 / 1000), rel=0.01)


def test_the_mean_has_the_interval_of_the_normal_distribution() -> None:
    values = np.array([1.0, 2.0, 3.0, 6.0])
    middle, low, high = mean(values)
    wide = NORMAL_95 * values.std(ddof=1) / 2.0
    assert (middle, low, high) == (3.0, pytest.approx(3.0 - wide), pytest.approx(3.0 + wide))
    assert mean([5.0]) == (5.0, -math.inf, math.inf)
    assert all(math.isnan(part) for part in mean([]))


def test_the_median_of_lives_that_all_ended_is_their_plain_median() -> None:
    rng = np.random.default_rng(1)
    times = rng.exponential(50.0, 401)
    median, low, high = median_life(times, np.ones(401, np.bool_))
    assert median == np.median(times)
    assert low < median < high


def test_the_median_is_right_for_censored_lives() -> None:
    # Lives of a known distribution, each watched for a random time only: the median of what was seen is far
    # too short, the estimate is not.
    rng = np.random.default_rng(2)
    covered, medians = 0, []
    for _ in range(200):
        lives, watched = rng.exponential(60.0, 300), rng.uniform(20.0, 200.0, 300)
        seen = np.minimum(lives, watched)
        median, low, high = median_life(seen, lives <= watched)
        medians.append(median)
        covered += low <= 60.0 * math.log(2.0) <= high
        assert np.median(seen) < median
    # 200 intervals of 95 %: 190 hold the truth, give or take four times √(200·0.95·0.05).
    assert abs(covered - 190) < 13
    assert np.mean(medians) == pytest.approx(60.0 * math.log(2.0), rel=0.02)


def test_the_median_of_a_worked_example() -> None:
    # One of 6 censored at 3 s. Survival: 5/6 at 1, 4/6 at 2, then of the 3 left at risk 2/3 and 1/3 of it.
    times = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    ended = np.array([True, True, False, True, True, True])
    assert median_life(times, ended)[0] == 4.0  # 4/6 · 2/3 = 0.444
    ended[2] = True
    assert median_life(times, ended)[0] == 3.0


def test_the_interquartile_mean_leaves_out_the_lower_and_the_upper_quarter() -> None:
    assert interquartile_mean([0.0, 1.0, 2.0, 1000.0]).value == 1.5
    assert interquartile_mean([[4.0, 5.0], [6.0, 7.0]]).value == 5.5
    assert interquartile_mean([3.0]) == (3.0, 3.0, 3.0)
    assert math.isnan(interquartile_mean([]).value)


def test_the_interval_of_the_interquartile_mean_holds_the_true_one_nineteen_times_in_twenty() -> None:
    rng = np.random.default_rng(1)
    inside = 0
    for draw in range(200):  # of a symmetric distribution, whose interquartile mean is 0
        estimate = interquartile_mean(rng.normal(size=100), draws=200, seed=draw)
        inside += estimate.low <= 0.0 <= estimate.high
    assert 180 <= inside <= 199  # 190 ± 3.2 standard deviations
