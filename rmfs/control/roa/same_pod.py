"""ROA same-pod: all bundles released for a pod go to one station, together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.base import Parameters
from rmfs.control.decisions import SendBundle
from rmfs.control.problems import Trigger
from rmfs.control.roa import ReplenishmentOrderAssignment

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.view import View
    from rmfs.world.stations import ReplenishmentStation


class SamePodParameters(Parameters):
    """Parameters of ROA same-pod."""

    first_come_first_served: bool = True
    """Whether a batch that fits nowhere holds up the batches after it."""


class SamePod(ReplenishmentOrderAssignment[SamePodParameters]):
    """Sends the batch of a pod to the nearest station on its tier that has room for all of it.

    A batch is what RPS has released for one pod and what has no station yet. Batches are taken in
    the order of their first release, so that one trip of a pod brings many bundles. Nearest is by
    Euclidean distance from where the pod is now, also while it is carried; of equally near
    stations the one with the lowest number. A batch larger than every station is split: as much
    of it as fits goes to the nearest empty station (RAWSim-O would wait for ever).
    """

    parameters_model = SamePodParameters
    subscriptions = frozenset({Trigger.BUNDLE_RELEASED})

    def __init__(self, parameters: SamePodParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        waypoints = [station.waypoint for station in view.replenishment_stations]
        self._waypoints = np.array(waypoints, np.int64)

    def decide(self) -> Iterator[SendBundle]:
        """Yield batch by batch until one fits nowhere."""
        for pod in list(self.view.bundles.released):
            batch = list(self.view.bundles.released[pod])
            space = sum(bundle.space for bundle in batch)
            station = self._nearest(pod, space)
            if station is None:
                if self.parameters.first_come_first_served:
                    return
                continue
            for bundle in batch:
                if bundle.space <= station.free_space:
                    yield SendBundle(bundle, station.index)

    def _nearest(self, pod: int, space: float) -> ReplenishmentStation | None:
        waypoint = self.view.pod_waypoint(pod)
        tier = self.view.travel.tier[waypoint]
        stations = self.view.replenishment_stations
        candidates = [
            position
            for position, station in enumerate(stations)
            if station.active
            and station.tier == tier
            and (space <= station.free_space or (station.used == 0 and space > station.capacity))
        ]
        if not candidates:
            return None
        distance = self.view.travel.metres(waypoint, self._waypoints[candidates])
        return stations[candidates[int(distance.argmin())]]
