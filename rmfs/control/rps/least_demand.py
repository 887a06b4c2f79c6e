"""RPS least-demand: chooses the pod whose SKUs are least in demand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.rps.buffered import Sticky, StickyParameters

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle


class LeastDemand(Sticky[StickyParameters]):
    """Chooses the pod with the least demand for its SKUs: the pod that pickers will miss least.

    The demand for a SKU is the number of its units that are ordered and not yet picked, in the
    backlog and at stations. The demand for a pod is the sum of the demands for the SKUs on it; how
    many units of them it holds does not matter. All pods are candidates, wherever they are. Ties go
    to the pod with the lowest number.
    """

    parameters_model = StickyParameters

    def choose_anew(self, bundle: Bundle) -> int:
        """Choose the pod with the least demand among those with room; -1 if there is none."""
        inventory = self.view.inventory
        demand = np.append(inventory.wanted, 0)
        return self.best(bundle, demand[inventory.skus_on].sum(axis=1))
