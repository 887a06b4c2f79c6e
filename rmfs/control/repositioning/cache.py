"""Repositioning cache: keeps some places near each pick station free for useful pods."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, NamedTuple

import numpy as np
import pydantic

from rmfs.control.repositioning import Move, Pauses, Pausing, nearest_place
from rmfs.control.trackers.pod_scores import Demand, DemandOnPods
from rmfs.control.trackers.prominence import Prominence
from rmfs.control.trackers.zones import ZoneParameters, Zones

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot

    Indices = NDArray[np.intp]

_EQUALS = 32
"""Maximum number of tied pairs of station and pod, in order of their numbers, whose moves are
compared by length.
"""


class CacheMoveParameters(ZoneParameters, Pauses):
    """Parameters of repositioning cache."""

    free_places: Annotated[int, pydantic.Field(ge=0)] = 8
    """Number of storage locations of each cache to keep free."""
    empty_below: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.4
    """A pod that is moved out of a cache goes near a replenishment station if less than this share
    of the pod's capacity is used."""
    count_backlog: bool = True
    """Whether demand includes the units that orders in the backlog need. If false, it consists only
    of the units that orders at stations need."""


class _Pairs(NamedTuple):
    """Pairs of a pod and a pick station."""

    pods: NDArray[np.intp]
    stations: NDArray[np.intp]

    def best(self, scores: NDArray[np.float64] | NDArray[np.int64]) -> _Pairs:
        """Keep the pairs with the highest score."""
        if len(self.pods) < 2:
            return self
        kept = scores == scores.max()
        return _Pairs(self.pods[kept], self.stations[kept])


class Cache(Pausing[CacheMoveParameters]):
    """Keeps a given number of storage locations free in the cache of each pick station.

    The cache of a pick station consists of storage locations near the station. If
    `drop_off_places` is positive, each pick station also has a drop-off zone: the storage locations
    that robots reach fastest from the station.

    If some caches have more free locations than the given number (`free_places`), a pod from
    outside all caches is moved into one of these caches. The pair of pod and cache is chosen by the
    following criteria; each criterion breaks the ties left by the previous ones:

    1. The pod is on the robot's tier.
    2. The pod can supply the most units that orders at the station of the cache need.
    3. The pod holds the most units in demand (see `count_backlog`).
    4. The pod is the fullest.
    5. The move is the shortest. At most 32 pairs are compared by this criterion.

    If there is no such move, a pod is moved out of a cache that has fewer free locations than the
    given number. The pod is chosen by the following criteria:

    1. The pod is on the robot's tier.
    2. The pod can supply the fewest units that orders at the station of its cache need.
    3. The pod holds the fewest units in demand.
    4. The pod is the emptiest.
    5. The pod is the nearest to a pick station.

    The pod goes to the nearest storage location outside all caches and drop-off zones. But if the
    pod is almost empty (`empty_below`), it goes to the one of these locations that is nearest to a
    replenishment station.

    Lengths of moves are Manhattan distances; distances to a station are travel times. Remaining
    ties go to the pod with the lowest number, then to the waypoint with the lowest number.
    """

    parameters_model = CacheMoveParameters

    def __init__(
        self, parameters: CacheMoveParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._zones = view.trackers.get(Zones, ZoneParameters.of(parameters))
        self._prominence = view.trackers.get(Prominence)
        kind: Demand = "unbound" if parameters.count_backlog else "assigned"
        self._demand = view.trackers.get(DemandOnPods, kind)
        self._outside = (self._zones.cache_of < 0) & (self._zones.drop_off_of < 0)
        self._index_at = np.full(view.layout.waypoints, -1, np.intp)
        self._index_at[view.storage.places] = np.arange(len(view.storage.places))
        self._to_replenishment = np.full(view.layout.waypoints, np.inf)
        for station in view.replenishment_stations:
            to = view.travel.to(station.waypoint, loaded=True)
            np.minimum(self._to_replenishment, to, out=self._to_replenishment)

    def find(self, robot: Robot) -> Move | None:
        """Find a pod to move into a cache or, if there is none, a pod to move out of a cache."""
        free = self._zones.cache_size - self._zones.occupied()
        wanted = np.minimum(self.parameters.free_places, self._zones.cache_size)
        pods = self.view.storage.is_at_hand.nonzero()[0]
        places = self._index_at[self.view.storage.pod_waypoint[pods]]
        return self._move_in(robot, pods, places, (free > wanted).nonzero()[0]) or self._move_out(
            robot, pods, places, (free < wanted).nonzero()[0]
        )

    def _move_in(
        self, robot: Robot, pods: Indices, places: Indices, stations: Indices
    ) -> Move | None:
        pods = self._on_tier(robot, pods[self._zones.cache_of[places] < 0])
        if not len(pods) or not len(stations):
            return None
        picks = np.stack([self._picks(station, pods) for station in stations.tolist()])
        row, column = (picks == picks.max()).nonzero()
        pairs = _Pairs(pods[column], stations[row])
        pairs = pairs.best(self._demand.units()[pairs.pods])
        pairs = pairs.best(self._fill(pairs.pods))
        equals = (pairs.pods[:_EQUALS], pairs.stations[:_EQUALS])
        moves = [self._into(pod, station) for pod, station in zip(*equals, strict=True)]
        return min(moves)[-1]

    def _into(self, pod: np.intp, station: np.intp) -> tuple[float, int, Move]:
        """Length in m of a pod's shortest move into a cache with a free place; pod; the move."""
        view = self.view
        among = view.storage.is_empty & (self._zones.cache_of == station)
        place = nearest_place(view, int(pod), among, "manhattan")
        start = view.storage.place_of[int(pod)]
        length = view.travel.manhattan_metres(start, np.array([place])).item()
        return length, int(pod), Move(int(pod), place)

    def _move_out(
        self, robot: Robot, pods: Indices, places: Indices, stations: Indices
    ) -> Move | None:
        empty = self.view.storage.is_empty & self._outside
        inside = np.isin(self._zones.cache_of[places], stations)
        pods = self._on_tier(robot, pods[inside])
        if not len(pods) or not empty.any():
            return None
        at = self._index_at[self.view.storage.pod_waypoint[pods]]
        pairs = _Pairs(pods, self._zones.cache_of[at])
        picks = np.empty(len(pods), np.int64)
        for station in np.unique(pairs.stations).tolist():
            own = pairs.stations == station
            picks[own] = self._picks(station, pods[own])
        pairs = pairs.best(-picks)
        pairs = pairs.best(-self._demand.units()[pairs.pods])
        pairs = pairs.best(-self._fill(pairs.pods))
        at = self._index_at[self.view.storage.pod_waypoint[pairs.pods]]
        pod = int(pairs.best(-self._prominence.seconds[at]).pods[0])
        if self._fill(np.array([pod])).item() < self.parameters.empty_below:
            reached = self._to_replenishment[self.view.storage.places[empty]]
            return Move(pod, int(self.view.storage.places[empty][reached.argmin()]))
        return Move(pod, nearest_place(self.view, pod, empty, "manhattan"))

    def _on_tier(self, robot: Robot, pods: NDArray[np.intp]) -> NDArray[np.intp]:
        """Keep only the pods on the robot's tier or, if there are none, all pods."""
        travel = self.view.travel
        if travel.tiers == 1:
            return pods
        near = pods[travel.tier[self.view.storage.pod_waypoint[pods]] == robot.tier]
        return near if len(near) else pods

    def _picks(self, station: int, pods: NDArray[np.intp]) -> NDArray[np.int64]:
        """Number of open requests of a station that each of the n pods can serve, shape (n,)."""
        units = np.zeros(len(pods), np.int64)
        need, available = self.view.need[station], self.view.inventory.available
        for sku in self.view.pick_stations[station].requests.lines:
            units += np.minimum(available[sku][pods], need[sku])
        return units

    def _fill(self, pods: NDArray[np.intp]) -> NDArray[np.float64]:
        """Share of capacity in use of each of the n pods, shape (n,)."""
        inventory = self.view.inventory
        share: NDArray[np.float64] = inventory.used[pods] / inventory.capacity[pods]
        return share
