"""Scores of pods by the demand for their contents and by the popularity of their SKUs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from rmfs.control.problems import Trigger
from rmfs.control.trackers import Tracker

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View

Demand = Literal["assigned", "unbound", "wanted"]
"""Which units count as demand. `assigned`: units that orders at stations need and that are not
bound to a pod. `unbound`: also such units of orders in the backlog. `wanted`: all units that are
ordered and not yet picked."""

_STEPS = 1 << 20  # popularity is counted in integers, so that sums never drift


def demand(view: View, kind: Demand) -> NDArray[np.int64]:
    """Return, for each of the K SKUs, the number of units in demand (see `Demand`), shape (K,)."""
    if kind == "wanted":
        return view.inventory.wanted
    units: NDArray[np.int64] = view.need.sum(axis=0, dtype=np.int64)
    if kind == "unbound":
        units += view.inventory.free_stock
        units -= view.inventory.uncommitted
    return units


class DemandOnPods(Tracker):
    """For each pod, the number of its units that are in demand.

    If a pod has more units of a SKU than are in demand, only the units in demand are counted.

    Changes of stock are counted as they happen. Changes of demand are counted when `units` is
    called; it processes only the SKUs whose demand has changed.
    """

    hears = frozenset({Trigger.UNIT_PICKED, Trigger.BUNDLE_STORED})

    def __init__(self, view: View, kind: Demand) -> None:
        super().__init__(view)
        self._kind = kind
        self._demand = demand(view, kind).copy()
        contained = view.inventory.contained
        self._units = np.zeros(contained.shape[1], np.int64)
        for sku in self._demand.nonzero()[0].tolist():
            self._units += np.minimum(contained[sku], self._demand[sku])

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Update the count of a pod from which a unit is picked or in which a bundle is stored."""
        if trigger is Trigger.UNIT_PICKED:
            (pod, sku), change = subject, -1
        else:
            pod, sku, change = subject.pod, subject.sku, subject.units
        wanted = self._demand.item(sku)
        if wanted:
            now = self.view.inventory.contained.item(sku, pod)
            self._units[pod] += min(now, wanted) - min(now - change, wanted)

    def units(self) -> NDArray[np.int64]:
        """Return the number of units in demand on each pod, shape (P,)."""
        new = demand(self.view, self._kind)
        contained, old = self.view.inventory.contained, self._demand
        for sku in (new != old).nonzero()[0].tolist():
            self._units += np.minimum(contained[sku], new[sku])
            self._units -= np.minimum(contained[sku], old[sku])
        old[:] = new
        return self._units


class PodScores(Tracker):
    """Scores of pods: how useful they are now, and how soon they will be needed again.

    *Utility* is the number of units on a pod that are in demand, where demand is all units
    ordered and not yet picked (`DemandOnPods`). *Speed* is the sum, over all units on a pod, of the
    popularity of the unit's SKU, that is, the weight with which the SKU is ordered. Utility and
    speed are each divided by their maximum over all pods.
    """

    hears = DemandOnPods.hears

    def __init__(self, view: View) -> None:
        super().__init__(view)
        self._useful = view.trackers.get(DemandOnPods, "wanted")
        popularity = view.skus.popularity
        weights = np.rint(popularity * (_STEPS / popularity.max())).astype(np.int64)
        self._weight: list[int] = weights.tolist()
        self._speed = np.zeros(len(view.inventory.capacity), np.int64)
        for sku, row in enumerate(view.inventory.contained):
            self._speed += row * weights[sku]

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Update the speed of a pod (how popular its contents are) after a pick or a delivery."""
        if trigger is Trigger.UNIT_PICKED:
            pod, sku = subject
            self._speed[pod] -= self._weight[sku]
        else:
            self._speed[subject.pod] += self._weight[subject.sku] * subject.units

    def scores(self, utility_weight: float, speed_weight: float) -> NDArray[np.float64]:
        """Return each pod's weighted mean of utility and speed, from 0 to 1, shape (P,).

        Parameters
        ----------
        utility_weight, speed_weight
            The weights, not both 0.
        """
        score = np.zeros(len(self._speed))
        if utility_weight:
            score += utility_weight * _share_of_best(self._useful.units())
        if speed_weight:
            score += speed_weight * _share_of_best(self._speed)
        return score / (utility_weight + speed_weight)


def _share_of_best(values: NDArray[np.int64]) -> NDArray[np.float64]:
    return values / max(int(values.max()), 1)
