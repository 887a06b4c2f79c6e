"""Which SKUs are ordered together."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from rmfs.scenario.categorical import Categorical

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray


@dataclass(frozen=True)
class Affinity:
    """Weights of pairs of SKUs, for lines whose SKU is drawn by affinity to the line before.

    For such a line, the probability of a SKU is in proportion to the weight of the pair (SKU of the
    line before, this SKU).

    Attributes
    ----------
    first, second
        SKU indices of the n pairs that have their own weights, shape (n,) each. `first` is the SKU
        of the line before, and `second` is the SKU of the line itself, so (a, b) and (b, a) are
        different pairs. If an .xgenc file (RAWSim-O) contains only one of these two pairs, the
        other is added with the same weight.
    weight
        Weight of each of these pairs, shape (n,).
    default_weight
        Weight of all other pairs.
    share
        Probability that a line after the first is drawn by affinity instead of popularity.
    """

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    weight: NDArray[np.float64]
    default_weight: float
    share: float

    def __post_init__(self) -> None:
        for array in (self.first, self.second, self.weight):
            array.setflags(write=False)

    def samplers(self, skus: int) -> Callable[[int], Categorical | None]:
        """Return a function that returns, for the SKU of a line, a sampler of the next line's SKU.

        The function returns None for a SKU if all pairs with this SKU as `first` have the weight 0.
        The memory of a sampler is in proportion to `skus`, the number of SKUs, so only recent
        samplers are cached.
        """
        order = np.argsort(self.first, kind="stable")
        starts = np.searchsorted(self.first[order], np.arange(skus + 1))

        @lru_cache(maxsize=1024)
        def sampler(sku: int) -> Categorical | None:
            pairs = order[starts[sku] : starts[sku + 1]]
            weights = np.full(skus, self.default_weight)
            weights[self.second[pairs]] = self.weight[pairs]
            return Categorical(weights) if weights.any() else None

        return sampler

    def digest(self) -> str:
        """Return the SHA-256 of all attributes."""
        hashed = hashlib.sha256(f"{self.default_weight!r} {self.share!r}".encode())
        for array in (self.first, self.second, self.weight):
            hashed.update(array.astype(array.dtype.newbyteorder("<")).tobytes())
        return hashed.hexdigest()
