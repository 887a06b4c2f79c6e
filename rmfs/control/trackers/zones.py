"""Zones of the storage area: a cache and a drop-off zone for each pick station."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.trackers import Tracker

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View

ZonePriority = Literal["drop-off", "cache", "equal"]
"""Which kind of zone chooses its storage locations first."""


class ZoneParameters(Parameters):
    """Parameters of zones; they must be equal in rules that work together (PSA, repositioning)."""

    cache_share: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.25
    """Share of all storage locations that belong to caches. The cache of a pick station consists of
    the storage locations from which a loaded robot reaches the station fastest; all caches are
    equally large."""
    drop_off_places: Annotated[int, pydantic.Field(ge=0)] = 0
    """Number of storage locations in the drop-off zone of each pick station: those that a loaded
    robot reaches fastest from the station."""
    zone_priority: ZonePriority = "drop-off"
    """Which kind of zone gets its storage locations first: `drop-off`, `cache`, or neither
    (`equal`)."""

    @classmethod
    def of(cls, parameters: ZoneParameters) -> ZoneParameters:
        """Extract the parameters of zones from those of a rule."""
        names = ZoneParameters.model_fields
        return ZoneParameters(**{name: getattr(parameters, name) for name in names})


class Zones(Tracker):
    """The zone, if any, to which each of the L storage locations (places) belongs.

    Each of the S pick stations has two zones: a cache of ceil(`cache_share` x L / S) places, from
    which robots reach the station quickly, and a drop-off zone of `drop_off_places` places, which
    robots reach quickly from the station.

    Places are assigned to zones one after another. Each time, a pair of an unassigned place and a
    zone that is not yet full is chosen, by these criteria in sequence: the priority of the kind of
    zone (`zone_priority`); the shortest travel time of a loaded robot (from the place to the
    station for a cache, from the station to the place for a drop-off zone); the longest travel time
    in the opposite direction; the lowest number of the place; drop-off zones before caches; the
    lowest number of the station.

    Attributes
    ----------
    cache_of, drop_off_of
        The pick station to whose cache, or to whose drop-off zone, each place belongs, shape
        (L,); -1 if there is none.
    cache_size
        Number of places of each cache, shape (S,); less than specified if there are not enough
        places.
    caches
        For each pick station, the indices of the places of its cache.
    """

    def __init__(self, view: View, parameters: ZoneParameters) -> None:
        super().__init__(view)
        stations, places = len(view.pick_stations), len(view.storage.places)
        cache = ceil(places * parameters.cache_share / stations - 1e-9)
        drop_off = parameters.drop_off_places
        zone_of = _greedy(view, parameters.zone_priority, cache, drop_off)
        self.cache_of: NDArray[np.int64] = np.where(zone_of >= stations, zone_of - stations, -1)
        self.drop_off_of: NDArray[np.int64] = np.where(zone_of < stations, zone_of, -1)
        held = self.cache_of[self.cache_of >= 0]
        self.cache_size: NDArray[np.int64] = np.bincount(held, minlength=stations)
        self.caches: list[NDArray[np.intp]] = [
            (self.cache_of == station).nonzero()[0] for station in range(stations)
        ]
        self._cache_mask: NDArray[np.bool_] = self.cache_of >= 0

    def occupied(self) -> NDArray[np.int64]:
        """Return how many places of each cache hold a pod or are reserved by robots, shape (S,)."""
        taken = self._cache_mask & ~self.view.storage.is_empty
        return np.bincount(self.cache_of[taken], minlength=len(self.cache_size))


def _greedy(view: View, priority: ZonePriority, cache: int, drop_off: int) -> NDArray[np.int64]:
    """Zone of each place: station for its drop-off zone, S + station for its cache, or -1, (L,)."""
    places = view.storage.places
    waypoints = [station.waypoint for station in view.pick_stations]
    to = np.stack([view.travel.to(waypoint, loaded=True)[places] for waypoint in waypoints])
    back = np.stack([view.travel.away(waypoint, loaded=True)[places] for waypoint in waypoints])
    # pairs of zone and place: drop-off zones of the S stations first, then their caches
    near, far = np.concatenate([back, to]).ravel(), np.concatenate([to, back]).ravel()
    zone, place = np.divmod(np.arange(len(near)), len(places))
    rank = {"drop-off": 1, "cache": -1, "equal": 0}[priority]
    kind = rank * (zone >= len(waypoints))
    in_order = np.lexsort((zone, place, -far, near, kind))
    left = [drop_off] * len(waypoints) + [cache] * len(waypoints)
    zone_of = np.full(len(places), -1, np.int64)
    wanted = sum(left)
    for position in in_order.tolist():
        if not wanted:
            break
        row, column = divmod(position, len(places))
        if left[row] and zone_of[column] < 0 and near.item(position) < np.inf:
            zone_of[column] = row
            left[row] -= 1
            wanted -= 1
    return zone_of
