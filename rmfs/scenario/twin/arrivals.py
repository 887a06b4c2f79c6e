"""Fit of arrivals: a Poisson rate for each hour of the day or the week."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import stats

from rmfs.scenario.twin.estimates import Estimate, rate

if TYPE_CHECKING:
    from numpy.typing import NDArray

HOUR_US = 3_600_000_000


class Arrivals(NamedTuple):
    """Fitted arrival rates.

    Attributes
    ----------
    mean
        Mean number of orders per hour.
    hours
        Rate in each hour of the day or week, in orders per hour.
    dispersion
        Ratio of variance to mean of the number of orders per hour, given the fitted rates; nan if
        there are too few hours. For a Poisson process, a ratio of 1 is expected.
    p
        Two-sided p value of a chi-square test of whether this ratio is 1; nan if there are too few
        hours.
    """

    mean: Estimate
    hours: list[Estimate]
    dispersion: float
    p: float


def fit_arrivals(time_us: NDArray[np.int64], days: int, cycle_h: int) -> Arrivals:
    """Fit the arrival rates.

    Parameters
    ----------
    time_us
        Arrival time of each order, in microseconds from 0:00 of the first day, shape (n,).
    days
        Number of observed days; each is observed from 0:00 to 24:00.
    cycle_h
        Period in h after which the rates repeat: 24 or 168.
    """
    each = np.bincount(time_us // HOUR_US, minlength=days * 24)
    of_cycle = np.arange(days * 24) % cycle_h
    watched = np.bincount(of_cycle, minlength=cycle_h)
    orders = np.bincount(of_cycle, each, minlength=cycle_h).astype(np.int64)
    hours = [
        rate(f"orders per h in hour {hour:02d}", int(orders[hour]), float(watched[hour]))
        for hour in range(cycle_h)
        if watched[hour]
    ]
    dispersion, p = _dispersion(each, (orders / np.maximum(watched, 1))[of_cycle], cycle_h)
    return Arrivals(rate("orders per h", len(time_us), days * 24.0), hours, dispersion, p)


def _dispersion(
    each: NDArray[np.int64], expected: NDArray[np.float64], parameters: int
) -> tuple[float, float]:
    """Return `dispersion` and `p` of `Arrivals`, from observed and expected orders per hour."""
    busy = expected > 0
    free = int(busy.sum()) - min(parameters, len(np.unique(np.flatnonzero(busy) % parameters)))
    if free < 1:
        return float("nan"), float("nan")
    square = float(((each[busy] - expected[busy]) ** 2 / expected[busy]).sum())
    return square / free, float(2 * min(stats.chi2.sf(square, free), stats.chi2.cdf(square, free)))
