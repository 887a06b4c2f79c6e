"""Estimates of fitted parameters, and measures of fit."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import stats

if TYPE_CHECKING:
    from numpy.typing import NDArray

LEVEL = 0.95
"""Confidence level of all intervals."""


class Estimate(NamedTuple):
    """An estimated parameter.

    Attributes
    ----------
    name
        Name of the parameter.
    value, low, high
        Estimated value, and the ends of its confidence interval at level `LEVEL`.
    """

    name: str
    value: float
    low: float
    high: float


class Agreement(NamedTuple):
    """A figure, such as a mean, computed for the orders of a file (the data) and for their twin.

    Attributes
    ----------
    name
        Name of the figure.
    data, twin
        Value of the figure for the data and for the twin; nan if it cannot be computed.
    p
        p value of the goodness-of-fit test for the figure; nan if there is no such test.
    """

    name: str
    data: float
    twin: float
    p: float = nan


def shares(name: str, counts: NDArray[np.int64]) -> list[Estimate]:
    """Return the relative frequency of each value 1, 2, ..., with Wilson's score interval.

    Parameters
    ----------
    name
        Beginning of the name of each estimate; the value (1, 2, ...) is appended.
    counts
        Number of occurrences of each value, shape (n,).
    """
    total = int(counts.sum())
    z = stats.norm.ppf(0.5 + LEVEL / 2)
    share = counts / total
    middle = (share + z * z / (2 * total)) / (1 + z * z / total)
    half = z * np.sqrt(share * (1 - share) / total + z * z / (4 * total**2)) / (1 + z * z / total)
    return [
        Estimate(f"{name} {number}", *map(float, row))
        for number, row in enumerate(
            zip(share, np.maximum(middle - half, 0), np.minimum(middle + half, 1), strict=True), 1
        )
    ]


def rate(name: str, count: int, hours: float) -> Estimate:
    """Return a Poisson rate per hour with its exact confidence interval (Garwood)."""
    tail = (1 - LEVEL) / 2
    low = stats.chi2.ppf(tail, 2 * count) / 2 if count else 0.0
    high = stats.chi2.ppf(1 - tail, 2 * count + 2) / 2
    return Estimate(name, count / hours, float(low) / hours, float(high) / hours)
