"""Faces of pods: which of them the units of each SKU lie on, and which one the picker sees."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.scenario.parameters.pickers import Faces

_HAIR = 1e-9
"""Rounding of sums of space, as a share."""


class PodFaces:
    """On which face of its pod every unit lies.

    Each face has an equal part of the pod's capacity. A bundle goes to the face with most room, and
    what does not fit there to the next; what fits on none to the face with most room all the same.

    Parameters
    ----------
    given
        What the scenario says.
    space_per_unit
        Of each SKU, shape (K,).
    capacity
        Of each pod, shape (P,).

    Attributes
    ----------
    used
        Space in use per pod and face, shape (P, F).
    """

    def __init__(
        self, given: Faces, space_per_unit: NDArray[np.float64], capacity: NDArray[np.float64]
    ) -> None:
        self._space = space_per_unit.tolist()
        self._capacity = (capacity / given.count).tolist()
        self.used = np.zeros((len(capacity), given.count))
        self._units: dict[tuple[int, int], list[int]] = {}

    def put(self, pod: int, sku: int, units: int) -> None:
        """Store units of a SKU."""
        space, used = self._space[sku], self.used[pod]
        lying = self._units.setdefault((pod, sku), [0] * len(used))
        for face in np.argsort(used, kind="stable").tolist():
            room = self._capacity[pod] * (1.0 + _HAIR) - float(used[face])
            fits = min(units, max(int(room / space), 0))
            lying[face] += fits
            used[face] += fits * space
            units -= fits
            if not units:
                return
        face = int(used.argmin())
        lying[face] += units
        used[face] += units * space

    def take(self, pod: int, sku: int, shown: int) -> int:
        """Take a unit from the face that is shown, else from that with most; returns the face.

        Parameters
        ----------
        shown
            The face that the picker sees; -1 if none is yet.
        """
        lying = self._units[pod, sku]
        face = shown if self.has(pod, sku, shown) else lying.index(max(lying))
        lying[face] -= 1
        self.used[pod, face] -= self._space[sku]  # multiples of 2**-20: the sums are exact
        if not any(lying):
            del self._units[pod, sku]
        return face

    def has(self, pod: int, sku: int, face: int) -> bool:
        """Whether a face has a unit of a SKU."""
        return face >= 0 and self._units.get((pod, sku), self._nothing)[face] > 0

    def units(self, pod: int, sku: int) -> int:
        """Return how many units of a SKU lie on a pod."""
        return sum(self._units.get((pod, sku), ()))

    @property
    def _nothing(self) -> list[int]:
        return [0] * self.used.shape[1]
