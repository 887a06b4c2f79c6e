"""Random draws of an index by given weights; each draw takes one uniform number."""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

SCALE = 2**40
"""Sum of the integer weights, up to rounding."""


class Categorical:
    """Indices 0, 1, ... with probabilities in proportion to given weights.

    Weights are converted to integers that sum to about `SCALE`, and a uniform number in [0, 1) is
    converted to an integer below their sum. Because integers are compared, a draw is the same on
    every platform: mathematics libraries may differ in the last bits of a weight, but these vanish
    in the rounding. With K weights, rounding changes no probability by more than about K / `SCALE`,
    and a positive weight never becomes zero.

    Parameters
    ----------
    weights
        Relative weights, shape (K,): finite, none negative, at least one positive.

    Raises
    ------
    ValueError
        If the weights are not valid.
    """

    def __init__(self, weights: ArrayLike) -> None:
        given = np.asarray(weights, dtype=np.float64)
        if given.ndim != 1 or not np.isfinite(given).all() or (given < 0).any() or not given.any():
            raise ValueError("weights must be finite and not negative, and one must be positive")
        # fsum is correctly rounded; the order of numpy's summation depends on the processor
        scaled = np.rint(given / math.fsum(given.tolist()) * SCALE).astype(np.int64)
        self._weights = np.where(given > 0, np.maximum(scaled, 1), 0)
        self._cumulative: list[int] = np.cumsum(self._weights).tolist()
        self._total = self._cumulative[-1]

    def __len__(self) -> int:
        return len(self._cumulative)

    @property
    def probabilities(self) -> NDArray[np.float64]:
        """Probability of each index, shape (K,)."""
        probabilities: NDArray[np.float64] = self._weights / self._total
        return probabilities

    def pick(self, uniform: float) -> int:
        """Return the index that a uniform number in [0, 1) selects."""
        return bisect_right(self._cumulative, int(uniform * self._total))

    def pick_among(self, allowed: NDArray[np.bool_], uniform: float) -> int | None:
        """Return the index that a uniform number in [0, 1) selects among the allowed ones.

        The probabilities of the allowed indices are in proportion to their weights.

        Parameters
        ----------
        allowed
            Whether each index may be drawn, shape (K,).

        Returns
        -------
        int or None
            None if no allowed index has a positive weight.
        """
        cumulative = np.cumsum(np.where(allowed, self._weights, 0))
        total = int(cumulative[-1])
        if total == 0:
            return None
        return int(np.searchsorted(cumulative, int(uniform * total), side="right"))
