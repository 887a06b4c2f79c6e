"""Layers of pods: in which layer each unit lies, and from which layer a unit is taken."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.world.pod_parts import PodParts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.scenario.parameters.pickers import Layers


class PodLayers(PodParts):
    """The layers in which the units of each pod lie.

    Parameters
    ----------
    given
        The scenario's parameters of layers.
    space_per_unit
        Space of one unit of each SKU, in space units, shape (K,).
    popularity
        Popularity of each SKU, shape (K,).
    capacity
        Capacity of each pod, in space units, shape (P,).
    """

    def __init__(
        self,
        given: Layers,
        space_per_unit: NDArray[np.float64],
        popularity: NDArray[np.float64],
        capacity: NDArray[np.float64],
    ) -> None:
        layers = len(given.time_factors)
        super().__init__(layers, space_per_unit, capacity)
        self._given = given
        self._by_time = sorted(range(layers), key=lambda layer: given.time_factors[layer])
        self._class = _classes(popularity, layers).tolist()

    def take(self, pod: int, sku: int) -> int:
        """Take a unit of a SKU, and return the layer from which it is taken.

        Among the layers with units of the SKU, this is the layer with the lowest factor on the time
        per unit.
        """
        lying = self._units[pod, sku]
        layer = next(layer for layer in self._by_time if lying[layer])
        self._take_from(pod, sku, layer)
        return layer

    def filled(self, pod: int, sku: int) -> list[int]:
        """Return the layers of a pod in the order in which units of a SKU are put into them."""
        if self._given.storing == "golden":
            return self._by_time
        if self._given.storing == "popular":
            own = self._class[sku]
            ranks = sorted(range(len(self._by_time)), key=lambda rank: (abs(rank - own), rank))
            return [self._by_time[rank] for rank in ranks]
        return self.roomiest_first(pod)


def _classes(popularity: NDArray[np.float64], layers: int) -> NDArray[np.int64]:
    """Divide the SKUs by popularity into one equal class per layer; class 0 is most popular."""
    rank = np.empty(len(popularity), np.int64)
    rank[np.argsort(-popularity, kind="stable")] = np.arange(len(popularity))
    return rank * layers // max(len(popularity), 1)
