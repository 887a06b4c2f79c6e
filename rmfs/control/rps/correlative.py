"""RPS correlative: chooses the pod whose SKUs are most often ordered with the bundle's SKU."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.rps.buffered import BufferParameters, EvenlyBuffered
from rmfs.control.trackers.frequency import PairFrequency

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.orders import Bundle


class Correlative(EvenlyBuffered[BufferParameters]):
    """Chooses the pod whose SKUs are most often ordered together with the bundle's SKU.

    For each SKU of a pod, the orders that contain both this SKU and the bundle's SKU are counted,
    including orders from before the run. The score of the pod is the sum of these numbers. All pods
    with room are candidates, wherever they are. Ties go to the pod with the lowest number.
    """

    parameters_model = BufferParameters

    def __init__(self, parameters: BufferParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._pairs = view.trackers.get(PairFrequency)

    def choose(self, bundle: Bundle) -> int:
        """Choose the pod with the highest score among those with room; -1 if there is none."""
        orders = self._pairs.orders_with(bundle.sku)
        return self.best(bundle, -orders[self.view.inventory.skus_on].sum(axis=1))
