"""Faces of pods: on which face each unit lies, and from which face a unit is taken."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.world.pod_parts import PodParts

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from rmfs.scenario.parameters.pickers import Faces


class PodFaces(PodParts):
    """The faces on which the units of each pod lie.

    A bundle goes to the face with the most room; units that do not fit there go to the face with
    the next most room, and so on.

    Parameters
    ----------
    given
        The scenario's parameters of faces.
    space_per_unit
        Space of one unit of each SKU, in space units, shape (K,).
    capacity
        Capacity of each pod, in space units, shape (P,).
    """

    def __init__(
        self, given: Faces, space_per_unit: NDArray[np.float64], capacity: NDArray[np.float64]
    ) -> None:
        super().__init__(given.count, space_per_unit, capacity)

    def filled(self, pod: int, sku: int) -> list[int]:
        """Return the faces of a pod in the order in which they are filled, the emptiest first."""
        return self.roomiest_first(pod)

    def take(self, pod: int, sku: int, shown: int) -> int:
        """Take a unit of a SKU, and return the face from which it is taken.

        The unit comes from the face `shown` if this face has a unit of the SKU, and otherwise from
        the face with the most units of the SKU.

        Parameters
        ----------
        shown
            The face that the picker sees; -1 if none yet.
        """
        lying = self._units[pod, sku]
        face = shown if self.has(pod, sku, shown) else lying.index(max(lying))
        self._take_from(pod, sku, face)
        return face

    def has(self, pod: int, sku: int, face: int) -> bool:
        """Whether a face has a unit of a SKU."""
        lying = self._units.get((pod, sku))
        return face >= 0 and lying is not None and lying[face] > 0
