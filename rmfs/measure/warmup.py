"""Convergence of a time series: proposals for the length of a warm-up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

BATCH = 5
"""Number of observations per batch mean: the 5 of MSER-5."""


def mser(values: ArrayLike, batch: int = BATCH) -> int | None:
    """Return how many initial observations to drop according to the marginal standard error rule.

    The rule (White 1997) drops the first d of the batch means Z_1 ... Z_n. It chooses the d <= n/2
    that minimises V / (n - d)², where V is the sum of (Z_j - m)² over all j > d, and m is the mean
    of these Z_j. With batches of five observations, it is called MSER-5.

    Parameters
    ----------
    values
        Equidistant observations; an incomplete batch at the end is ignored.
    batch
        Number of observations per batch.

    Returns
    -------
    int | None
        A multiple of `batch`; None if the series is too short, that is, if there are fewer than
        four batches or the minimum is at the largest permitted d.
    """
    observed = np.asarray(values, np.float64)
    number = len(observed) // batch
    if number < 4:
        return None
    means = observed[: number * batch].reshape(number, batch).mean(axis=1)
    tested = range(number // 2 + 1)
    errors = [float(np.var(means[drop:]) / (number - drop)) for drop in tested]
    best = int(np.argmin(errors))
    return None if best == tested[-1] else best * batch


def welch(values: ArrayLike, window: int) -> NDArray[np.float64]:
    """Return the moving average of Welch's method.

    Observation i (from 0) is averaged with its w neighbours on either side, where w is the smaller
    of i and `window`. No averages are returned for the last `window` observations.

    Raises
    ------
    ValueError
        If the window is less than 1 or greater than half the number of observations.
    """
    observed = np.asarray(values, np.float64)
    if not 1 <= window <= len(observed) // 2:
        raise ValueError(f"window {window}: must be from 1 to half of {len(observed)} observations")
    before = np.concatenate([[0.0], np.cumsum(observed)])
    middle = np.arange(len(observed) - window)
    reach = np.minimum(middle, window)
    smooth = before[middle + reach + 1] - before[middle - reach]
    means: NDArray[np.float64] = smooth / (2 * reach + 1)
    return means


def settled(smooth: ArrayLike, tolerance: float = 0.05) -> int | None:
    """Return the index from which a smoothed series stays near the mean of its second half.

    Parameters
    ----------
    tolerance
        Largest permitted deviation from that mean, as a share of it.

    Returns
    -------
    int | None
        The index; None if the deviation exceeds the tolerance anywhere in the second half.
    """
    values = np.asarray(smooth, np.float64)
    half = len(values) // 2
    level = float(values[half:].mean())
    outside = np.flatnonzero(np.abs(values - level) > tolerance * abs(level))
    first = int(outside[-1]) + 1 if len(outside) else 0
    return first if first <= half else None
