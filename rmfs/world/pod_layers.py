"""Layers of pods: on which of them the units of each SKU lie."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from rmfs.scenario.parameters.pickers import Layers

_HAIR = 1e-9
"""Rounding of sums of space, as a share."""


class PodLayers:
    """Where in its pod every unit lies.

    Each layer has an equal part of the pod's capacity. What fits into no layer, though the pod has
    room for it in all, goes to the layer with most room.

    Parameters
    ----------
    given
        What the scenario says.
    space_per_unit
        Of each SKU, shape (K,).
    popularity
        Of each SKU, shape (K,).
    capacity
        Of each pod, shape (P,).

    Attributes
    ----------
    used
        Space in use per pod and layer, shape (P, L).
    """

    def __init__(
        self,
        given: Layers,
        space_per_unit: NDArray[np.float64],
        popularity: NDArray[np.float64],
        capacity: NDArray[np.float64],
    ) -> None:
        self._given = given
        self._space = space_per_unit.tolist()
        layers = len(given.time_factors)
        self._by_time = sorted(range(layers), key=lambda layer: given.time_factors[layer])
        self._class = _classes(popularity, layers).tolist()
        self._capacity = (capacity / layers).tolist()
        self.used = np.zeros((len(capacity), layers))
        self._units: dict[tuple[int, int], list[int]] = {}

    def put(self, pod: int, sku: int, units: int) -> None:
        """Store units of a SKU."""
        space, used = self._space[sku], self.used[pod]
        lying = self._units.setdefault((pod, sku), [0] * len(used))
        for layer in self._order(pod, sku):
            room = self._capacity[pod] * (1.0 + _HAIR) - float(used[layer])
            fits = min(units, max(int(room / space), 0))
            lying[layer] += fits
            used[layer] += fits * space
            units -= fits
            if not units:
                return
        layer = int(used.argmin())
        lying[layer] += units
        used[layer] += units * space

    def take(self, pod: int, sku: int) -> int:
        """Take a unit from the fastest layer that has one; returns the layer."""
        lying = self._units[pod, sku]
        layer = next(layer for layer in self._by_time if lying[layer])
        lying[layer] -= 1
        self.used[pod, layer] -= self._space[sku]  # multiples of 2**-20: the sums are exact
        if not any(lying):
            del self._units[pod, sku]
        return layer

    def units(self, pod: int, sku: int) -> int:
        """Return how many units of a SKU lie in a pod."""
        return sum(self._units.get((pod, sku), ()))

    def _order(self, pod: int, sku: int) -> Iterable[int]:
        """Return the layers in the order in which they are filled."""
        if self._given.storing == "golden":
            return self._by_time
        if self._given.storing == "popular":
            own = self._class[sku]
            ranks = sorted(range(len(self._by_time)), key=lambda rank: (abs(rank - own), rank))
            return [self._by_time[rank] for rank in ranks]
        return [int(layer) for layer in np.argsort(self.used[pod], kind="stable")]


def _classes(popularity: NDArray[np.float64], layers: int) -> NDArray[np.int64]:
    """Cut SKUs by popularity into as many equal classes as there are layers; 0: most popular."""
    rank = np.empty(len(popularity), np.int64)
    rank[np.argsort(-popularity, kind="stable")] = np.arange(len(popularity))
    return rank * layers // max(len(popularity), 1)
