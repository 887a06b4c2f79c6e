"""PSA nearest: chooses the empty storage location nearest to the robot with the pod."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pydantic

from rmfs.control.congestion import CongestionParameters
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.distances import PlaceDistances
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class NearestParameters(CongestionParameters):
    """Parameters of PSA nearest."""

    metric: Metric = "time"
    """Measure of the distance from the robot to a storage location: `euclidean` or `manhattan` (in
    m), `path` (length in m of a loaded robot's shortest path) or `time` (travel time in s of a
    loaded robot if no other robot delays it)."""

    @pydantic.model_validator(mode="after")
    def _seconds_only(self) -> NearestParameters:
        if self.congestion and self.metric != "time":
            raise ValueError("congestion: needs metric = 'time'")
        return self


class Nearest(PodStorageAssignment[NearestParameters]):
    """Chooses the nearest empty storage location, by default the one with the least travel time.

    The delay that congestion is expected to cause on the way can be added to the travel time
    (`congestion`). Ties go to the waypoint with the lowest number.
    """

    parameters_model = NearestParameters

    def __init__(self, parameters: NearestParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._distances = PlaceDistances(view, parameters.metric)
        parameters.prepare(view)

    def place(self, robot: Robot) -> int:
        """Find the empty storage location nearest to the robot; -1 if there is none."""
        storage, here = self.view.storage, robot.waypoint
        delay_s = self.parameters.delay_s(self.view, here, storage.places)
        return self.least(self._distances.away(here) + delay_s, storage.is_empty)
