"""Estimates with 95 % intervals, the ones of all metrics: means, ratios, differences, shares, lives.

Means, ratios and their differences are smooth functions of the means of columns, so their intervals are those
of the delta method: the normal distribution of what each case contributes. `Moments` sums columns up in parts
of any size, so figures of a billion games need no more memory than those of ten.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

NORMAL_95 = 1.959963984540054  # quantile of the normal distribution: 95 % lie within ± this


class Estimate(NamedTuple):
    """A figure with the interval that holds the true one with 95 %."""

    value: float
    low: float
    high: float


UNKNOWN = Estimate(math.nan, math.nan, math.nan)
"""The estimate when there are no cases."""


class Moments:
    """The means and products of some columns over independent cases, added in parts.

    Source: T. F. Chan, G. H. Golub, R. J. LeVeque, "Updating formulae and a pairwise algorithm for computing
    sample variances" (1979).

    Attributes:
        count: Cases.
        means: Of each column [column].
        products: Sums of products of deviations from the means [column, column].
    """

    def __init__(self, columns: int) -> None:
        self.count = 0
        self.means = np.zeros(columns)
        self.products = np.zeros((columns, columns))

    def add(self, values: NDArray[Any]) -> None:
        """Add cases, [case, column]."""
        array = np.asarray(values, np.float64)
        count = len(array)
        if count == 0:
            return
        means = array.mean(axis=0)
        away, apart = array - means, means - self.means
        total = self.count + count
        # Not a matrix product, whose bits depend on the library and its threads.
        self.products += (away[:, :, None] * away[:, None, :]).sum(axis=0)
        self.products += np.outer(apart, apart) * (self.count * count / total)
        self.means += apart * (count / total)
        self.count = total

    def ratio(self, above: int, below: int) -> Estimate:
        """Σ column `above` / Σ column `below`, neither ever negative; see `ratio`."""
        value, weights = self._ratio(above, below)
        if math.isnan(value):
            return UNKNOWN
        wide = self._half_width(weights)
        return Estimate(value, max(0.0, value - wide), value + wide)

    def ratio_difference(self, first: tuple[int, int], second: tuple[int, int]) -> Estimate:
        """One ratio minus another, each of (above, below), over the same cases."""
        (one, weights), (other, others) = self._ratio(*first), self._ratio(*second)
        wide = self._half_width(weights - others)
        return Estimate(one - other, one - other - wide, one - other + wide)

    def _ratio(self, above: int, below: int) -> tuple[float, NDArray[np.float64]]:
        """A ratio, and how much each column's mean contributes to it."""
        weights = np.zeros(len(self.means))
        if self.count == 0 or self.means[below] == 0.0:
            return math.nan, weights
        value = float(self.means[above] / self.means[below])
        weights[above] += 1.0 / self.means[below]
        weights[below] -= value / self.means[below]
        return value, weights

    def _half_width(self, weights: NDArray[np.float64]) -> float:
        if self.count < 2:
            return math.inf
        square = float((weights[:, None] * self.products * weights[None, :]).sum())
        return half_width(square / (self.count - 1), self.count)


def half_width(variance: float, count: int) -> float:
    """Half of the interval of a mean of cases with this variance; rounding may have made it negative."""
    return NORMAL_95 * math.sqrt(max(variance, 0.0) / count)


def mean(values: ArrayLike) -> Estimate:
    """The mean of independent values, with the interval of the normal distribution."""
    array = np.asarray(values, np.float64)
    if len(array) == 0:
        return UNKNOWN
    middle = float(array.mean())
    wide = half_width(float(array.var(ddof=1)), len(array)) if len(array) > 1 else math.inf
    return Estimate(middle, middle - wide, middle + wide)


def ratio(above: ArrayLike, below: ArrayLike) -> Estimate:
    """Σ above / Σ below over independent cases, neither ever negative.

    The interval is that of the residuals, above − ratio·below, whose sum is nearly normal.
    Source: W. G. Cochran, "Sampling Techniques" (1977), chapter 6, the ratio estimate.

    Args:
        above: Numerators [case].
        below: Denominators [case].

    Returns:
        The ratio; `UNKNOWN` where all denominators are 0.
    """
    a, b = np.asarray(above, np.float64), np.asarray(below, np.float64)
    if not b.any():
        return UNKNOWN
    value = float(a.sum() / b.sum())
    _, low, high = mean((a - value * b) / b.mean())
    return Estimate(value, max(0.0, value + low), value + high)


class RatioSums(NamedTuple):
    """Sums over independent cases from which a ratio follows.

    Attributes:
        cases: How many.
        above: Σ above.
        below: Σ below.
        above_square: Σ above².
        product: Σ above·below.
        below_square: Σ below².
    """

    cases: int
    above: float
    below: float
    above_square: float
    product: float
    below_square: float

    def estimate(self) -> Estimate:
        """The ratio, as by `ratio`; `UNKNOWN` where all denominators are 0."""
        if self.below == 0.0:
            return UNKNOWN
        value, square = self.above / self.below, self.above_square
        square += value * (value * self.below_square - 2.0 * self.product)
        if self.cases < 2:
            return Estimate(value, 0.0, math.inf)
        middle = self.below / self.cases
        wide = half_width(square / (self.cases - 1), self.cases) / middle
        return Estimate(value, max(0.0, value - wide), value + wide)


def quotient(above: Estimate, below: Estimate) -> Estimate:
    """One estimate divided by another one of other cases, both above 0.

    The relative errors of both add like the sides of a right angle.
    Source: the delta method, for example A. van der Vaart, "Asymptotic Statistics" (1998), chapter 3.
    """
    if not (above.value > 0.0 and below.value > 0.0):
        return UNKNOWN
    value = above.value / below.value
    wide = value * math.hypot(
        (above.high - above.low) / (2.0 * above.value), (below.high - below.low) / (2.0 * below.value)
    )
    return Estimate(value, max(0.0, value - wide), value + wide)


def share(count: int, of: int) -> Estimate:
    """A share of independent cases, valid for rare ones too; `UNKNOWN` where there are no cases.

    Source: E. B. Wilson, Journal of the American Statistical Association 22 (1927).
    """
    if of == 0:
        return UNKNOWN
    p, z = count / of, NORMAL_95
    middle = (p + z * z / (2.0 * of)) / (1.0 + z * z / of)
    wide = z / (1.0 + z * z / of) * math.sqrt(p * (1.0 - p) / of + z * z / (4.0 * of * of))
    low = middle - wide if count > 0 else 0.0  # exactly, without rounding
    high = middle + wide if count < of else 1.0
    return Estimate(p, low, high)


class Survival(NamedTuple):
    """The share of lives that last longer than each moment, by the estimate of Kaplan and Meier.

    Attributes:
        moments: Times at which lives ended [s], in order.
        alive: The share that lives on after each.
        low: The lower end of its interval.
        high: The upper end.
    """

    moments: NDArray[Any]
    alive: NDArray[Any]
    low: NDArray[Any]
    high: NDArray[Any]

    def median(self) -> Estimate:
        """The median life [s]; a value is inf where its curve stays above one half."""
        return Estimate(*(self._passed(curve) for curve in (self.alive, self.low, self.high)))

    def _passed(self, curve: NDArray[Any]) -> float:
        """The moment at which a curve falls to one half."""
        found = np.nonzero(curve <= 0.5)[0]
        return float(self.moments[found[0]]) if len(found) else math.inf


def survival(moments: NDArray[Any], deaths: NDArray[np.int64], censored: NDArray[np.int64]) -> Survival:
    """The survival of lives, some of which were censored: observed for a time, but not to their end.

    Sources: E. L. Kaplan, P. Meier, "Nonparametric estimation from incomplete observations", J. Am. Stat.
    Assoc. 53 (1958); interval: R. Brookmeyer, J. Crowley, "A confidence interval for the median survival
    time", Biometrics 38 (1982), with the log-log transformation.

    Args:
        moments: Times in ascending order [s].
        deaths: How many lives ended at each.
        censored: How many were last observed alive at each.
    """
    left = np.cumsum((deaths + censored)[::-1])[::-1]
    happens = deaths > 0
    d, n = deaths[happens].astype(np.float64), left[happens].astype(np.float64)
    alive = np.cumprod(1.0 - d / n)
    low, high = np.zeros_like(alive), np.zeros_like(alive)
    goes_on = alive > 0.0
    variance = np.cumsum(d[goes_on] / (n[goes_on] * (n[goes_on] - d[goes_on])))
    spread = np.exp(NORMAL_95 * np.sqrt(variance) / np.abs(np.log(alive[goes_on])))
    low[goes_on], high[goes_on] = alive[goes_on] ** spread, alive[goes_on] ** (1.0 / spread)
    return Survival(moments[happens], alive, low, high)


def median_life(times: NDArray[np.float64], ended: NDArray[np.bool_]) -> Estimate:
    """The median life, by `survival`.

    Args:
        times: How long each was observed alive [s], shape [case].
        ended: Whether its life ended then; otherwise it was censored, shape [case].

    Returns:
        The median [s]; a value is inf where its curve stays above one half.
    """
    moments, place = np.unique(times, return_inverse=True)
    deaths = np.bincount(place[ended], minlength=len(moments))
    return survival(moments, deaths, np.bincount(place[~ended], minlength=len(moments))).median()


def interquartile_mean(scores: ArrayLike, draws: int = 2000, seed: int = 0) -> Estimate:
    """The mean of the middle half of some scores, with a bootstrap interval.

    Runs and cases are drawn again, independently of each other, so that the interval covers both another
    training and other cases.
    Sources: R. Agarwal and others, "Deep reinforcement learning at the edge of the statistical precipice",
    NeurIPS 2021, for the figure; A. B. Owen, "The pigeonhole bootstrap", Ann. Appl. Stat. 1 (2007), for
    drawing rows and columns.

    Args:
        scores: A score for each run (for example a training) and case (a board), [run, case] or [case].
        draws: Samples of the bootstrap.
        seed: Of its random numbers; the same seed gives the same interval.

    Returns:
        The estimate; `UNKNOWN` where there are no scores.
    """
    table = np.atleast_2d(np.asarray(scores, np.float64))
    if table.size == 0:
        return UNKNOWN
    rng, (runs, cases) = np.random.default_rng(seed), table.shape
    means = np.empty(draws)
    for draw in range(draws):
        rows, columns = rng.integers(0, runs, (runs, 1)), rng.integers(0, cases, cases)
        means[draw] = _middle_mean(table[rows, columns])
    low, high = np.quantile(means, (0.025, 0.975)).tolist()
    return Estimate(_middle_mean(table), low, high)


def _middle_mean(scores: NDArray[np.float64]) -> float:
    """The mean without the lower and the upper quarter, whose numbers are rounded down."""
    flat = scores.reshape(-1)
    cut = len(flat) // 4
    middle = np.partition(flat, (cut, len(flat) - cut - 1))[cut : len(flat) - cut]
    return float(middle.mean())
