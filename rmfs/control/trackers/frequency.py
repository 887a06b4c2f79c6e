"""How often SKUs, and pairs of SKUs, have been ordered."""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.control.problems import Trigger
from rmfs.control.trackers import Tracker

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from rmfs.control.view import View


class Frequency(Tracker):
    """Number of units ordered per SKU, including orders from before the run."""

    def __init__(self, view: View) -> None:
        super().__init__(view)
        self._before = np.zeros(len(view.skus), np.int64)
        for content in view.past_orders:
            for sku, units in zip(content.skus, content.units, strict=True):
                self._before[sku] += units

    @property
    def units(self) -> NDArray[np.int64]:
        """Number of units ordered of each of the K SKUs, shape (K,)."""
        return self._before + self.view.inventory.ordered

    @property
    def share(self) -> NDArray[np.float64]:
        """Units ordered of each SKU, divided by the units of the most ordered SKU, shape (K,)."""
        units = self.units
        return units / max(int(units.max()), 1)


class PairFrequency(Tracker):
    """For each pair of SKUs, the number of orders that contain both.

    It counts orders from before the run, the backlog when the tracker starts, and orders that
    arrive afterwards.
    """

    hears = frozenset({Trigger.NEW_ORDER})

    def __init__(self, view: View) -> None:
        super().__init__(view)
        self._orders: dict[int, dict[int, int]] = {}
        for content in view.past_orders:
            self._count(content.skus)
        for order in view.orders:
            self._count(line.sku for line in order.lines)

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Count the pairs of a new order."""
        self._count(line.sku for line in subject.lines)

    def orders_with(self, sku: int) -> NDArray[np.int64]:
        """Return, for each SKU, the number of orders that contain it together with the given SKU.

        The shape is (K + 1,). The entry of the given SKU itself is 0. The last entry, with index K,
        is also 0, so that rows of `Inventory.skus_on`, which are padded with K, can be used as
        indices.
        """
        counts = np.zeros(len(self.view.skus) + 1, np.int64)
        partners = self._orders.get(sku)
        if partners:
            counts[list(partners)] = list(partners.values())
        return counts

    def _count(self, skus: Iterable[int]) -> None:
        for one, other in permutations(skus, 2):
            partners = self._orders.setdefault(one, {})
            partners[other] = partners.get(other, 0) + 1
