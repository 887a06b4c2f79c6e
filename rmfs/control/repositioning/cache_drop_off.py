"""Repositioning cache-drop-off: clears drop-off zones, and fills caches to a target level."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.psa.caching import CacheParameters, Caching
from rmfs.control.repositioning import Move, Pauses, Pausing, nearest_place
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class CacheDropOffParameters(CacheParameters, Pauses):
    """Parameters of repositioning cache-drop-off."""

    target_fill: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.8
    """Share of each cache's storage locations that should hold pods."""
    same_tier: bool = False
    """Whether pods are moved only by robots on their tier, and only within the tier."""
    metric: Metric = "manhattan"
    """Measure of the length of a move: `euclidean` or `manhattan` (in m), `path` (length in m of a
    loaded robot's shortest path) or `time` (travel time in s of a loaded robot if no other robot
    delays it)."""


class CacheDropOff(Pausing[CacheDropOffParameters]):
    """Clears drop-off zones, then moves pods into or out of caches towards a target number of pods.

    The drop-off zone of a pick station consists of the storage locations that robots reach fastest
    from the station. The cache of the station consists of other storage locations near it. The
    score of a pod, and the condition under which it deserves a place in a cache, are those of PSA
    `cache`.

    For each station, the actual number of occupied storage locations in its cache is compared with
    the target number (`target_fill`). The stations are considered in order of the absolute
    difference of the two numbers, the largest first. If the drop-off zone of the station contains
    pods, the pod with the highest score is moved. It goes into the cache of the station if it
    deserves a place there and the cache has room; otherwise, it goes outside all caches and
    drop-off zones.

    If no pod in a drop-off zone can be moved, the caches are considered in the same order. If a
    cache has too few pods, the candidate is the pod with the highest score outside all caches and
    drop-off zones; it is moved in if it deserves a place. If a cache has too many pods, the pod
    with the lowest score in the cache is moved outside all caches and drop-off zones.

    No pod is moved into a drop-off zone. A pod goes to the nearest empty storage location of the
    area to which it is moved. Ties between pods or stations go to the lowest number, and ties
    between storage locations to the lowest waypoint number.
    """

    parameters_model = CacheDropOffParameters

    def __init__(
        self, parameters: CacheDropOffParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._caching = Caching(view, parameters)
        self._zones = self._caching.zones
        self._target = np.rint(self._zones.cache_size * parameters.target_fill).astype(np.int64)
        self._outside = (self._zones.cache_of < 0) & (self._zones.drop_off_of < 0)
        places = view.storage.places
        self._drop_off_at = np.full(view.layout.waypoints, -1, np.int64)
        self._drop_off_at[places] = self._zones.drop_off_of

    def find(self, robot: Robot) -> Move | None:
        """Find a move that clears a drop-off zone or, if there is none, that levels a cache."""
        storage = self.view.storage
        pods = storage.is_at_hand.nonzero()[0]
        if self.parameters.same_tier:
            pods = pods[self.view.travel.tier[storage.pod_waypoint[pods]] == robot.tier]
        scores = self._caching.scores()
        short = self._target - self._zones.occupied()
        stations = np.argsort(-np.abs(short), kind="stable").tolist()
        at = storage.pod_waypoint[pods]
        for station in stations:
            dropped = pods[self._drop_off_at[at] == station]
            if len(dropped):
                move = self._clear(_best(dropped, scores), station, scores)
                if move is not None:
                    return move
        for station in stations:
            move = self._level(station, int(short[station]), pods, scores)
            if move is not None:
                return move
        return None

    def _clear(self, pod: int, station: int, scores: NDArray[np.float64]) -> Move | None:
        """Move a pod out of a drop-off zone."""
        if self._caching.is_worth(pod, station, scores):
            move = self._to(pod, self._zones.cache_of == station)
            if move is not None:
                return move
        return self._to(pod, self._outside)

    def _level(
        self, station: int, short: int, pods: NDArray[np.intp], scores: NDArray[np.float64]
    ) -> Move | None:
        """Move a pod into a cache with too few pods, or out of a cache with too many."""
        at = self.view.storage.pod_waypoint[pods]
        if short > 0:
            stored = pods[(self._caching.cache_at[at] < 0) & (self._drop_off_at[at] < 0)]
            if not len(stored):
                return None
            pod = _best(stored, scores)
            worth = self._caching.is_worth(pod, station, scores)
            return self._to(pod, self._zones.cache_of == station) if worth else None
        if short < 0:
            cached = pods[self._caching.cache_at[at] == station]
            return self._to(_best(cached, -scores), self._outside) if len(cached) else None
        return None

    def _to(self, pod: int, zone: NDArray[np.bool_]) -> Move | None:
        """Move a pod to the nearest empty place of a zone."""
        among = zone & self.view.storage.is_empty
        if self.parameters.same_tier:
            tier = self.view.travel.tier
            among &= tier[self.view.storage.places] == tier[self.view.storage.place_of[pod]]
        place = nearest_place(self.view, pod, among, self.parameters.metric)
        return Move(pod, place) if place >= 0 else None


def _best(pods: NDArray[np.intp], scores: NDArray[np.float64]) -> int:
    """Return the pod with the highest score; ties go to the pod with the lowest number."""
    return int(pods[scores[pods].argmax()])
