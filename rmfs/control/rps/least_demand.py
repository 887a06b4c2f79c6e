"""RPS least-demand: chooses the pod whose SKUs are least in demand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.rps.buffered import Sticky, StickyParameters

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle


class LeastDemand(Sticky[StickyParameters]):
    """Chooses the pod with the least demand for its SKUs: the pod least needed for picking.

    The demand for a SKU is the number of its units that are ordered and not yet picked, in the
    backlog and at stations. The demand for a pod is the sum of the demands for the SKUs on it; the
    numbers of units on the pod do not matter. All pods with room are candidates, wherever they are.
    Ties go to the pod with the lowest number. By default, the chosen pod is kept for further
    bundles until one of them does not fit or a replenishment station serves the pod
    (`stick_to_pod`).
    """

    parameters_model = StickyParameters

    def choose_anew(self, bundle: Bundle) -> int:
        """Choose the pod with the least demand among those with room; -1 if there is none."""
        inventory = self.view.inventory
        demand = np.append(inventory.wanted, 0)
        return self.best(bundle, demand[inventory.skus_on].sum(axis=1))
