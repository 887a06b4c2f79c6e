"""Which SKUs are ordered together."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.scenario.categorical import Categorical

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_KEPT = 1024
"""Maximum number of samplers kept."""


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

    def samplers(self, skus: int) -> AffinitySamplers:
        """Return the samplers of the line after a line with a given SKU; `skus`: number of SKUs."""
        return AffinitySamplers(self, skus)

    def digest(self) -> str:
        """Return the SHA-256 of all attributes."""
        hashed = hashlib.sha256(f"{self.default_weight!r} {self.share!r}".encode())
        for array in (self.first, self.second, self.weight):
            hashed.update(array.astype(array.dtype.newbyteorder("<")).tobytes())
        return hashed.hexdigest()


class AffinitySamplers:
    """Samplers of the SKU of a line, given the SKU of the line before.

    The memory of a sampler is in proportion to the number of SKUs, so only the `MOST_KEPT` samplers
    used last are kept. Copies of a run create theirs anew.

    Parameters
    ----------
    affinity
        Weights of pairs of SKUs.
    skus
        Number of SKUs.
    """

    def __init__(self, affinity: Affinity, skus: int) -> None:
        self._affinity, self._skus = affinity, skus
        self._order = np.argsort(affinity.first, kind="stable")
        self._starts = np.searchsorted(affinity.first[self._order], np.arange(skus + 1))
        self._kept: dict[int, Categorical | None] = {}

    def __call__(self, sku: int) -> Categorical | None:
        """Return the sampler of the line after a line with this SKU.

        The result is None if all pairs with this SKU as `first` have the weight 0.
        """
        kept = self._kept
        sampler = kept.pop(sku) if sku in kept else self._made(sku)
        kept[sku] = sampler
        if len(kept) > MOST_KEPT:
            del kept[next(iter(kept))]
        return sampler

    def _made(self, sku: int) -> Categorical | None:
        affinity = self._affinity
        pairs = self._order[self._starts[sku] : self._starts[sku + 1]]
        weights = np.full(self._skus, affinity.default_weight)
        weights[affinity.second[pairs]] = affinity.weight[pairs]
        return Categorical(weights) if weights.any() else None

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the samplers."""
        return self.__dict__ | {"_kept": {}}
