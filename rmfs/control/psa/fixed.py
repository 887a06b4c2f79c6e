"""PSA fixed: every pod has a fixed storage location."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.base import NoParameters
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.distances import PlaceDistances

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class Fixed(PodStorageAssignment[NoParameters]):
    """Stores every pod at the storage location where it stood at the start of the run.

    If that location is occupied, the pod is stored at the empty location with the least travel time
    from the robot. The pod's own location can be occupied by another pod (stored there by
    repositioning or by a PSA rule installed earlier) or by a robot (resting there because there is
    no pod to rest beneath).
    """

    def __init__(self, parameters: NoParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._own: list[int] = view.layout.pod_waypoint.tolist()
        self._distances = PlaceDistances(view, "time")

    def place(self, robot: Robot) -> int:
        """Return the pod's own storage location if it is empty, otherwise the nearest empty one."""
        storage = self.view.storage
        own = self._own[robot.pod]
        if storage.is_empty[storage.place_index[own]]:
            return own
        return self.least(self._distances.away(robot.waypoint), storage.is_empty)
