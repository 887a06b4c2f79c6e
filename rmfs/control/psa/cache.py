"""PSA cache: stores useful pods in the cache of the nearest pick station, others outside caches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.psa import PodStorageAssignment
from rmfs.control.psa.caching import CacheParameters, Caching
from rmfs.control.psa.distances import PlaceDistances
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class CachePlaceParameters(CacheParameters):
    """Parameters of PSA cache."""

    metric: Metric = "time"
    """Measure of the distance from the pick station to a storage location: `euclidean` or
    `manhattan` (in m), `path` (length in m of a loaded robot's shortest path) or `time` (travel
    time in s of a loaded robot if no other robot delays it)."""


class Cache(PodStorageAssignment[CachePlaceParameters]):
    """Stores useful pods in the cache of the nearest pick station, and other pods outside caches.

    A cache consists of storage locations near a pick station (`rmfs.control.trackers.zones`). The
    rule considers the cache of the pick station that is nearest to the pod by Euclidean distance,
    even if the pod comes from a replenishment station. The pod deserves a place in this cache if
    the weighted mean of two shares is above a threshold: the share of the cache that is free, and
    the share of the pods in the cache that have a lower score than this pod. The score of a pod is
    the weighted mean of its utility and speed (`rmfs.control.trackers.pod_scores`).

    Areas are tried in sequence until one has an empty storage location. For a pod that deserves a
    place in the cache, the sequence is this cache, the locations outside all caches, and the other
    caches. For any other pod, the sequence is the locations outside all caches, and then all
    caches. Within the area, the empty location nearest to the pick station is chosen; ties go to
    the waypoint with the lowest number.
    """

    parameters_model = CachePlaceParameters

    def __init__(
        self, parameters: CachePlaceParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._caching = Caching(view, parameters)
        self._distances = PlaceDistances(view, parameters.metric)
        self._stations = np.array([station.waypoint for station in view.pick_stations])

    def place(self, robot: Robot) -> int:
        """Choose a storage location in the area that suits the pod, or else in another area."""
        empty, cache_of = self.view.storage.is_empty, self._caching.zones.cache_of
        station = int(self.view.travel.metres(robot.waypoint, self._stations).argmin())
        outside = cache_of < 0
        if self._caching.is_worth(robot.pod, station, self._caching.scores()):
            own = cache_of == station
            groups = (own, outside, ~own & ~outside)
        else:
            groups = (outside, ~outside, np.zeros_like(outside))
        distances = self._distances.away(int(self._stations[station]))
        for group in groups:
            place = self.least(distances, empty & group)
            if place >= 0:
                return place
        return -1
