"""Parts of pods, such as layers or faces, and the units of each SKU in them."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

_HAIR = 1e-9
"""Tolerance for rounding errors in sums of space, as a share of the capacity."""


class PodParts:
    """The parts in which the units of each pod lie.

    Each part has an equal share of the pod's capacity. A unit that fits into no single part goes to
    the part with the most room.

    Parameters
    ----------
    parts
        Number of parts.
    space_per_unit
        Space of one unit of each SKU, in space units, shape (K,).
    capacity
        Capacity of each pod, in space units, shape (P,).

    Attributes
    ----------
    used
        Space in use per pod and part, in space units, shape (P, parts).
    """

    def __init__(
        self, parts: int, space_per_unit: NDArray[np.float64], capacity: NDArray[np.float64]
    ) -> None:
        self._space = space_per_unit.tolist()
        self._capacity = (capacity / parts).tolist()
        self.used = np.zeros((len(capacity), parts))
        self._units: dict[tuple[int, int], list[int]] = {}

    @abstractmethod
    def filled(self, pod: int, sku: int) -> Iterable[int]:
        """Return the parts of a pod in the order in which units of a SKU are put into them."""

    def put(self, pod: int, sku: int, units: int) -> None:
        """Store units of a SKU in a pod."""
        space, used = self._space[sku], self.used[pod]
        lying = self._units.setdefault((pod, sku), [0] * len(used))
        for part in self.filled(pod, sku):
            room = self._capacity[pod] * (1.0 + _HAIR) - float(used[part])
            fits = min(units, max(int(room / space), 0))
            lying[part] += fits
            used[part] += fits * space
            units -= fits
            if not units:
                return
        part = int(used.argmin())
        lying[part] += units
        used[part] += units * space

    def units(self, pod: int, sku: int) -> int:
        """Return how many units of a SKU lie in a pod."""
        return sum(self._units.get((pod, sku), ()))

    def roomiest_first(self, pod: int) -> list[int]:
        """Return the parts of a pod, the one with the most room first; ties go to lower numbers."""
        return [int(part) for part in np.argsort(self.used[pod], kind="stable")]

    def _take_from(self, pod: int, sku: int, part: int) -> None:
        lying = self._units[pod, sku]
        lying[part] -= 1
        self.used[pod, part] -= self._space[sku]  # multiples of 2**-20: the sums are exact
        if not any(lying):
            del self._units[pod, sku]
