"""Fit of popularity: gamma-distributed weights, fitted to how many times each SKU was ordered.

Only one line of each order is counted, because orders are independent, whereas the lines of an
order are not. With gamma-distributed weights, the counts have a negative binomial distribution. As
SKUs that were never ordered are not in the file, the likelihood is conditional on a count above
zero. The fitted distribution also yields the share of SKUs never ordered, and thus the total number
of SKUs.
"""

from __future__ import annotations

from math import exp
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import optimize, special, stats

from rmfs.errors import InputError
from rmfs.scenario.twin.estimates import LEVEL, Estimate

if TYPE_CHECKING:
    from numpy.typing import NDArray

LEAST_SKUS = 10
LEAST_IN_BIN = 5.0
FACTORS = (0.03, 0.1, 0.3, 1.0)
"""Factors on the mean of the positive counts; the search for the overall mean starts from these."""


class Popularity(NamedTuple):
    """Fitted gamma distribution of the SKUs' weights.

    Attributes
    ----------
    shape
        Shape of the gamma distribution, whose mean is 1.
    skus
        Total number of SKUs, including those never ordered.
    p
        p value of a chi-square test of the counts, grouped in bins; nan if there are too few bins.
    """

    shape: Estimate
    skus: Estimate
    p: float


def fit_popularity(counts: NDArray[np.int64]) -> Popularity:
    """Fit the gamma distribution of the SKUs' weights by maximum likelihood.

    Parameters
    ----------
    counts
        Number of times that each SKU was ordered, shape (K,). All counts are at least 1, because
        SKUs that were never ordered are left out.

    Raises
    ------
    InputError
        If there are too few SKUs, or no SKU was ordered more than once.
    """
    values, often = np.unique(counts, return_counts=True)
    if len(counts) < LEAST_SKUS or values[-1] < 2:
        raise InputError(
            f"there are too few orders for a fit: at least {LEAST_SKUS} SKUs are needed, one of "
            f"them ordered twice (given: {len(counts)} SKUs, each ordered at most {values[-1]} "
            "times)"
        )

    def loss(logs: NDArray[np.float64]) -> float:
        return -float(often @ _log_likelihood(values, *np.exp(logs)))

    # not below a thousandth: then there would be SKUs without end
    limits = [(np.log(1e-3), np.log(1e4)), (np.log(1e-6), np.log(1e9))]
    grid = [(s, m) for s in (0.01, 0.05, 0.2, 1.0, 5.0) for m in counts.mean() * np.array(FACTORS)]
    begin = min((np.log(pair) for pair in grid), key=loss)
    found = optimize.minimize(
        loss,
        begin,
        method="Nelder-Mead",
        bounds=limits,
        # steps of their own: by default they are shares of the logarithms, which may be 0
        options={
            "xatol": 1e-7,
            "fatol": 1e-9,
            "maxiter": 2000,
            "initial_simplex": begin + np.array([[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]]),
        },
    )
    covariance = np.linalg.pinv(_curvature(loss, found.x)).astype(np.float64)
    shape, mean = map(float, np.exp(found.x))
    z = float(stats.norm.ppf(0.5 + LEVEL / 2))
    wide = z * float(np.sqrt(max(covariance[0, 0], 0.0)))
    return Popularity(
        Estimate("popularity shape", shape, shape * exp(-wide), shape * exp(wide)),
        _skus(len(counts), found.x, covariance, z),
        _chi_square(values, often, shape, mean),
    )


def _log_likelihood(n: NDArray[np.int64], shape: float, mean: float) -> NDArray[np.float64]:
    """Log probability of a count, given that it is above 0."""
    below = np.log(shape) - np.log(shape + mean)
    log_p: NDArray[np.float64] = (
        special.gammaln(n + shape)
        - special.gammaln(shape)
        - special.gammaln(n + 1)
        + shape * below
        + n * (np.log(mean) - np.log(shape + mean))
    )
    return log_p - float(np.log(-np.expm1(shape * below)))


def _skus(
    seen: int, logs: NDArray[np.float64], covariance: NDArray[np.float64], z: float
) -> Estimate:
    """Estimate the number of SKUs: those seen, divided by the probability of being seen.

    The interval is computed for the number of unseen SKUs on the log scale, so that it stays above
    the number seen. It covers the error of the parameters (delta method) and that of sampling.
    """

    def log_unseen(at: NDArray[np.float64]) -> float:
        shape, mean = np.exp(at)
        never = (shape / (shape + mean)) ** shape
        return float(np.log(seen * never / (1.0 - never)))

    step = 1e-4
    slope = np.array(
        [(log_unseen(logs + one) - log_unseen(logs - one)) / (2 * step) for one in np.eye(2) * step]
    )
    unseen = exp(log_unseen(logs))
    never = unseen / (seen + unseen)
    drawn = seen * never / (1.0 - never) ** 2 / max(unseen, 1e-12) ** 2
    wide = z * float(np.sqrt(max(slope @ covariance @ slope, 0.0) + drawn))
    low, high = unseen * exp(-wide), unseen * exp(min(wide, 50.0))
    return Estimate("SKUs", seen + unseen, seen + low, seen + high)


def _curvature(loss: object, at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrix of second derivatives, computed by finite differences."""
    step = 1e-3
    ways = np.eye(2) * step
    made = np.empty((2, 2))
    for i in range(2):
        for j in range(2):
            a, b = ways[i], ways[j]
            corners = loss(at + a + b) - loss(at + a - b) - loss(at - a + b) + loss(at - a - b)  # type: ignore[operator]
            made[i, j] = corners / (4 * step * step)
    return made


def _chi_square(
    values: NDArray[np.int64], often: NDArray[np.int64], shape: float, mean: float
) -> float:
    """Return the p value of a chi-square test of the counts; nan if there are too few bins."""
    most = int(min(values[-1], 100_000))
    each = np.exp(_log_likelihood(np.arange(1, most + 1), shape, mean)) * often.sum()
    seen = np.zeros(most)
    np.add.at(seen, np.minimum(values, most) - 1, often)
    expected, observed, bins = 0.0, 0.0, []
    for one, found in zip(each, seen, strict=True):
        expected, observed = expected + float(one), observed + float(found)
        if expected >= LEAST_IN_BIN:
            bins.append((observed, expected))
            expected = observed = 0.0
    rest = float(often.sum()) - sum(e for _, e in bins)
    left = float(often.sum()) - sum(o for o, _ in bins)
    if rest >= LEAST_IN_BIN or not bins:
        bins.append((left, rest))
    else:
        last = bins.pop()
        bins.append((last[0] + left, last[1] + rest))
    if len(bins) < 4:
        return float("nan")
    table = np.array(bins)
    statistic = ((table[:, 0] - table[:, 1]) ** 2 / table[:, 1]).sum()
    return float(stats.chi2.sf(statistic, len(bins) - 3))
