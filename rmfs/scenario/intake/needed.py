"""Replenishment of SKUs that run short: too few of their units are left for further orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.scenario.bundles import bundle_of_each
from rmfs.scenario.clock import US_PER_S
from rmfs.scenario.intake.backlog import Rest
from rmfs.scenario.intake.intake import BundleArrival

if TYPE_CHECKING:
    from rmfs.scenario.clock import Openings
    from rmfs.scenario.intake.state import State
    from rmfs.scenario.parameters import NeededReplenishment
    from rmfs.scenario.skus import SkuSet


class NeededBundles:
    """An intake process that generates bundles of SKUs that run short.

    The units left of a SKU are its stored units, plus those in bundles that have arrived and are
    not stored yet, minus those that orders still need. A SKU is short if fewer units are left
    than the reorder point, `reorder_below_units`. With a reorder point of 0, a SKU is therefore
    short only if orders need more units than are stored or have arrived in bundles. The SKU with
    the fewest units left comes first; ties go to the lowest index.

    Parameters
    ----------
    config
        The table `replenishment` of a scenario.
    skus
        The SKUs, with their bundle sizes.
    capacity
        Total capacity of all pods, in space units.
    openings
        Tells whether a time is outside the down periods, in which nothing is generated.
    """

    def __init__(
        self, config: NeededReplenishment, skus: SkuSet, capacity: float, openings: Openings
    ) -> None:
        self._config = config
        self._bundles = bundle_of_each(skus)
        self._limit = config.load_limit_share * capacity
        self._rest = Rest(openings)

    @property
    def next_us(self) -> int:
        """End of the current pause or down period in us; `NEVER_US` if there is none."""
        return self._rest.until_us

    def draw(self, now_us: int, state: State) -> BundleArrival | None:
        """Return a bundle of the SKU with the fewest units left; None if this SKU is not short.

        The result is also None in a down period, if the maximum number of bundles is waiting, or if
        the bundle would exceed the load limit. The last case starts a pause, in which the result is
        None as well.
        """
        if not self._rest.ends(now_us) or state.waiting_bundles >= self._config.bundles:
            return None
        left = state.uncommitted + state.incoming
        sku = int(np.argmin(left))
        if left[sku] >= self._config.reorder_below_units:
            return None
        bundle = self._bundles[sku]
        if state.load + bundle.space > self._limit:
            self._rest.block(now_us, now_us / US_PER_S + self._config.retry_s)
            return None
        return BundleArrival(now_us, *bundle)
