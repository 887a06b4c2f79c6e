"""Contents of replenishment bundles."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.random import Stream
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from rmfs.scenario.skus import SkuSet


class BundleContent(NamedTuple):
    """The content of a bundle: a SKU, the number of its units, and the space units they take."""

    sku: int
    units: int
    space: float


class BundleSource:
    """Draws bundles, each with a SKU drawn by popularity; bundle k is drawn from substream k.

    Parameters
    ----------
    skus
        The SKUs, with their bundle sizes.
    seed
        The run's seed.
    return_share
        Probability that a bundle is a return of a single unit from a customer.
    path
        Numbers that select a branch of the random stream (see `Substreams`); bundles that are
        numbered separately, such as those of batches, have a branch of their own.
    """

    def __init__(
        self, skus: SkuSet, seed: int, return_share: float = 0.0, path: tuple[int, ...] = ()
    ) -> None:
        self._substreams = Substreams(seed, Stream.BUNDLE_CONTENTS, path)
        self._pick = skus.by_popularity.pick
        self._bundles = bundle_of_each(skus)
        self._space_per_unit: list[float] = skus.space_per_unit.tolist()
        self._return_share = return_share

    def draw(self, ordinal: int) -> BundleContent:
        """Return bundle number `ordinal`, 0 or greater; equal ordinals give equal bundles."""
        uniform = self._substreams.at(ordinal)
        sku = self._pick(uniform())
        if self._return_share and uniform() < self._return_share:
            return BundleContent(sku, 1, self._space_per_unit[sku])
        return self._bundles[sku]


def bundle_of_each(skus: SkuSet) -> list[BundleContent]:
    """Return one bundle of every SKU, in the order of the SKUs."""
    columns = (skus.bundle_units.tolist(), skus.bundle_space.tolist())
    return [BundleContent(sku, *rest) for sku, rest in enumerate(zip(*columns, strict=True))]
