"""PSA fixed: every pod has a place of its own."""

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
    """Takes every pod back to the place where it stood at the start of the run.

    Where that place is not empty, the nearest empty place by travel time is taken for the time
    being: another rule (repositioning, or a predecessor) may have stored a pod there, and a robot
    may rest there in the rare case that no pod is left to rest beneath.
    """

    def __init__(self, parameters: NoParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._own: list[int] = view.layout.pod_waypoint.tolist()
        self._distances = PlaceDistances(view, "time")

    def place(self, robot: Robot) -> int:
        """Look up the pod's own place."""
        storage = self.view.storage
        own = self._own[robot.pod]
        if storage.is_empty[storage.place_index[own]]:
            return own
        return self.least(self._distances.away(robot.waypoint), storage.is_empty)
