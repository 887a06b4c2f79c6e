"""PSA nearest: chooses the empty storage location nearest to the pod."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.base import Parameters
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.distances import PlaceDistances
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class NearestParameters(Parameters):
    """Parameters of PSA nearest."""

    metric: Metric = "time"
    """Measure of distance: `euclidean`, `manhattan` (m), `path` (m along the waypoints, as a loaded
    robot drives) or `time` (s, unhindered)."""


class Nearest(PodStorageAssignment[NearestParameters]):
    """Chooses the nearest empty storage location, by default the one with the least travel time.

    Ties go to the waypoint with the lowest number.
    """

    parameters_model = NearestParameters

    def __init__(self, parameters: NearestParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._distances = PlaceDistances(view, parameters.metric)

    def place(self, robot: Robot) -> int:
        """Find the empty storage location nearest to the robot; -1 if there is none."""
        return self.least(self._distances.away(robot.waypoint), self.view.storage.is_empty)
