"""RPS least-demand: the pod whose SKUs are least in demand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.rps.buffered import Sticky, StickyParameters

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle


class LeastDemand(Sticky[StickyParameters]):
    """Chooses the pod with the least demand for its SKUs, which pickers will miss least.

    The demand for a SKU is the number of units ordered and not yet picked, in the backlog and at
    stations. The demand for a pod is the sum of the total demands for the SKUs it contains. All
    pods are candidates, wherever they are. Ties: the pod with the lowest number.
    """

    parameters_model = StickyParameters

    def choose_anew(self, bundle: Bundle) -> int:
        """Choose the pod with the least demand among those with room."""
        inventory = self.view.inventory
        demand = np.append(inventory.wanted, 0)
        return self.best(bundle, demand[inventory.skus_on].sum(axis=1))
