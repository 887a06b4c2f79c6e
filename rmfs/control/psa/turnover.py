"""PSA turnover: stores fast-moving pods near the pick stations, and slow ones far away."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.distances import PlaceDistances
from rmfs.control.trackers.turnover import TurnoverClasses, TurnoverParameters
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class TurnoverPlaceParameters(TurnoverParameters):
    """Parameters of PSA turnover."""

    within_class: Literal["nearest", "nearest-to-station", "random"] = "nearest"
    """Choice among the empty storage locations of a class: the one nearest to the pod (`nearest`),
    the one nearest to a pick station (`nearest-to-station`), or a random one (`random`)."""
    metric: Metric = "time"
    """Measure of the distances that `within_class` compares: `euclidean` or `manhattan` (in m),
    `path` (length in m of a loaded robot's shortest path) or `time` (travel time in s of a loaded
    robot if no other robot delays it)."""


class Turnover(PodStorageAssignment[TurnoverPlaceParameters]):
    """Chooses an empty storage location of the pod's turnover class, or else of another class.

    Pods and storage locations are divided into classes from fast to slow
    (`rmfs.control.trackers.turnover`). If the pod's class has no empty location, other classes are
    tried: one class slower, one faster, two slower, two faster, and so on. The parameter
    `within_class` determines the choice within a class; ties go to the waypoint with the lowest
    number.
    """

    parameters_model = TurnoverPlaceParameters

    def __init__(
        self, parameters: TurnoverPlaceParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        shared = TurnoverParameters.of(parameters)
        self._classes = view.trackers.get(TurnoverClasses, shared)
        self._distances = PlaceDistances(view, parameters.metric)
        stations = [station.waypoint for station in view.pick_stations]
        self._to_station = self._distances.to_nearest(stations)

    def place(self, robot: Robot) -> int:
        """Choose an empty storage location of the pod's class, or else of another; -1 if none."""
        empty = self.view.storage.is_empty
        place_class = self._classes.place_class
        for number in _outward(int(self._classes.pod_class[robot.pod]), self._classes.classes):
            place = self._within(robot, empty & (place_class == number))
            if place >= 0:
                return place
        return -1

    def _within(self, robot: Robot, among: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> int:
        if self.parameters.within_class == "nearest":
            return self.least(self._distances.away(robot.waypoint), among)
        if self.parameters.within_class == "nearest-to-station":
            return self.least(self._to_station, among)
        places = self.view.storage.places[among]
        return int(places[self.draw(len(places))]) if len(places) else -1


def _outward(start: int, count: int) -> Iterator[int]:
    """Numbers from 0 to `count` - 1: the start, one above, one below, two above, and so on."""
    yield start
    for step in range(1, count):
        if start + step < count:
            yield start + step
        if start - step >= 0:
            yield start - step
