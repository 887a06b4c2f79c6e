"""Contents of replenishment bundles."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.random import Stream
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from rmfs.scenario.skus import SkuSet


class BundleDraft(NamedTuple):
    """A bundle before it exists: so many units of one SKU, and the space units they take."""

    sku: int
    units: int
    space: float


class BundleSource:
    """Draws bundles, the SKU by popularity; bundle k comes from substream (seed, k).

    Parameters
    ----------
    skus
        The SKUs, with their bundle sizes.
    seed
        The run's seed.
    """

    def __init__(self, skus: SkuSet, seed: int) -> None:
        self._substreams = Substreams(seed, Stream.BUNDLE_CONTENTS)
        self._pick = skus.by_popularity.pick
        self._bundles = bundle_of_each(skus)

    def draw(self, ordinal: int) -> BundleDraft:
        """Draw the bundle of an ordinal, 0 or greater."""
        return self._bundles[self._pick(self._substreams.at(ordinal)())]


def bundle_of_each(skus: SkuSet) -> list[BundleDraft]:
    """Return the bundle of every SKU, in the order of the SKUs."""
    columns = (skus.bundle_units.tolist(), skus.bundle_space.tolist())
    return [BundleDraft(sku, *rest) for sku, rest in enumerate(zip(*columns, strict=True))]
