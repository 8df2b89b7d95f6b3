"""Estimates with 95 % intervals: means, ratios, shares, and the median of partly censored lives."""

from __future__ import annotations

import math
from typing import NamedTuple

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


def mean(values: ArrayLike) -> Estimate:
    """The mean of independent values, with the interval of the normal distribution."""
    array = np.asarray(values, np.float64)
    if len(array) == 0:
        return UNKNOWN
    middle = float(array.mean())
    wide = NORMAL_95 * float(array.std(ddof=1)) / math.sqrt(len(array)) if len(array) > 1 else math.inf
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


def median_life(times: NDArray[np.float64], ended: NDArray[np.bool_]) -> Estimate:
    """The median life, by the Kaplan–Meier estimate of survival, which allows for censored lives.

    Sources: E. L. Kaplan, P. Meier, "Nonparametric estimation from incomplete observations", J. Am. Stat.
    Assoc. 53 (1958); interval: R. Brookmeyer, J. Crowley, "A confidence interval for the median survival
    time", Biometrics 38 (1982), with the log-log transformation.

    Args:
        times: How long each was observed alive [s], shape [case].
        ended: Whether its life ended then; otherwise it was censored, shape [case].

    Returns:
        The median [s]; a value is inf where its curve stays above one half.
    """
    survival, variance = 1.0, 0.0
    found = [math.inf, math.inf, math.inf]  # median, low, high
    for moment in np.unique(times[ended]):
        at_risk = int((times >= moment).sum())
        deaths = int((times[ended] == moment).sum())
        survival *= 1.0 - deaths / at_risk
        low = high = 0.0
        if survival > 0.0:
            variance += deaths / (at_risk * (at_risk - deaths))
            spread = NORMAL_95 * math.sqrt(variance) / abs(math.log(survival))
            low, high = survival ** math.exp(spread), survival ** math.exp(-spread)
        for place, curve in enumerate((survival, low, high)):
            if curve <= 0.5 and found[place] == math.inf:
                found[place] = float(moment)
    return Estimate(*found)
