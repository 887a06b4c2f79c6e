"""ROA same-pod: sends all bundles released for a pod to one station, together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.control.base import Parameters
from rmfs.control.decisions import SendBundle
from rmfs.control.problems import Problem, Trigger
from rmfs.control.roa import ReplenishmentOrderAssignment
from rmfs.control.turns import Turn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rmfs.control.view import View
    from rmfs.world.orders import Bundle
    from rmfs.world.stations import ReplenishmentStation

StationRule = Literal["nearest", "emptiest", "fullest", "least-busy", "most-busy", "random"]

_SCORES: dict[str, Callable[[ReplenishmentStation], float]] = {
    "emptiest": lambda station: station.used / station.capacity,
    "fullest": lambda station: -station.used / station.capacity,
    "least-busy": lambda station: station.bundles,
    "most-busy": lambda station: -station.bundles,
}


class SamePodParameters(Parameters):
    """Parameters of ROA same-pod."""

    station: StationRule = "nearest"
    """Which station with room is chosen: the one nearest to the pod (`nearest`), the one with the
    lowest (`emptiest`) or highest (`fullest`) share of its capacity in use, the one with the fewest
    (`least-busy`) or most (`most-busy`) bundles, or a random one (`random`)."""
    break_batches: bool = False
    """Whether the bundles for a pod are sent one by one, possibly to several stations, instead of
    together."""
    first_come_first_served: bool = True
    """Whether a batch for which no station has room holds up all batches that came after it. This
    parameter has no effect if `break_batches` is true."""
    same_tier: bool = True
    """Whether only stations on the current tier of the pod are considered. As long as this tier has
    no station that is on, the bundles for the pod wait, without blocking other batches."""


class SamePod(ReplenishmentOrderAssignment[SamePodParameters]):
    """Sends the batch of bundles for a pod to one station with room for the whole batch.

    A batch consists of the bundles that RPS has released for one pod and that have no station yet.
    If they are sent together, the pod makes only one trip. Batches are considered in the order in
    which their first bundles were released. The parameter `station` determines the choice of the
    station. By default, it is the station with the shortest straight-line distance from the pod's
    current position, even if the pod is being carried. Ties go to the station with the lowest
    number.

    An empty station may be chosen even if its capacity is too small for the batch. The station then
    gets as many bundles of the batch as fit.

    With `break_batches`, bundles are sent one by one. The parameter `station` determines the
    station of the first bundle for a pod. Each further bundle goes to the station of the previous
    bundle for the same pod. If the previous station has no room or is switched off, the station
    with room that is nearest to the previous station is chosen. Bundles that fit nowhere wait,
    without blocking later bundles.
    """

    parameters_model = SamePodParameters
    subscriptions = frozenset({Trigger.BUNDLE_RELEASED})
    waits_for = frozenset({Problem.RPS})

    def __init__(self, parameters: SamePodParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._last: dict[int, ReplenishmentStation] = {}

    def decide(self) -> Iterator[SendBundle]:
        """Yield assignments batch by batch or, with `break_batches`, bundle by bundle."""
        return self._bundles() if self.parameters.break_batches else Batches(self)

    def _bundles(self) -> Iterator[SendBundle]:
        for pod in list(self.view.bundles.released):
            for bundle in list(self.view.bundles.released[pod]):
                station = self._for_bundle(pod, bundle.space)
                if station is not None:
                    self._last[pod] = station
                    yield SendBundle(bundle, station.index)

    def _for_bundle(self, pod: int, space: float) -> ReplenishmentStation | None:
        stations = self._with_room(pod, space)
        last = self._last.get(pod)
        if last is None:
            return self._by_rule(pod, stations)
        return last if last in stations else self._nearest(last.waypoint, stations)

    def _with_room(self, pod: int, space: float, split: bool = False) -> list[ReplenishmentStation]:
        """Find stations with room; with `split`, also empty stations with room for a part only."""
        return [
            station
            for station in self._on(pod)
            if space <= station.free_space
            or (split and station.used == 0 and space > station.capacity)
        ]

    def can_go_on(self, pod: int) -> bool:
        """Return whether any station to which the pod may be brought is switched on."""
        return bool(self._on(pod))

    def for_batch(self, pod: int, batch: Sequence[Bundle]) -> ReplenishmentStation | None:
        """Choose the station of a batch of bundles for a pod; None if no station has room."""
        space = sum(bundle.space for bundle in batch)
        return self._by_rule(pod, self._with_room(pod, space, split=True))

    def _on(self, pod: int) -> list[ReplenishmentStation]:
        """Return the stations considered for a pod that are on, with room or without."""
        tier = self.view.travel.tier[self.view.pod_waypoint(pod)]
        return [
            station
            for station in self.view.replenishment_stations
            if station.active and (station.tier == tier or not self.parameters.same_tier)
        ]

    def _by_rule(
        self, pod: int, stations: list[ReplenishmentStation]
    ) -> ReplenishmentStation | None:
        rule = self.parameters.station
        if not stations:
            return None
        if rule == "nearest":
            return self._nearest(self.view.pod_waypoint(pod), stations)
        if rule == "random":
            return stations[self.draw(len(stations))]
        return min(stations, key=_SCORES[rule])

    def _nearest(
        self, waypoint: int, stations: list[ReplenishmentStation]
    ) -> ReplenishmentStation | None:
        if not stations:
            return None
        waypoints = np.array([station.waypoint for station in stations])
        return stations[int(self.view.travel.metres(waypoint, waypoints).argmin())]


class Batches(Turn[SendBundle]):
    """The decisions of one call of the rule, batch by batch."""

    def __init__(self, rule: SamePod) -> None:
        self._rule = rule
        self._pods: Iterator[int] | None = None
        self._batch: Iterator[Bundle] = iter(())
        self._station: ReplenishmentStation | None = None

    def __next__(self) -> SendBundle:
        rule, released = self._rule, self._rule.view.bundles.released
        if self._pods is None:
            self._pods = iter(list(released))
        while True:
            for bundle in self._batch:
                assert self._station is not None
                if bundle.space <= self._station.free_space:
                    return SendBundle(bundle, self._station.index)
            pod = next(self._pods)
            if not rule.can_go_on(pod):
                continue  # there is no queue in which the batch could be the first
            batch = list(released[pod])
            self._station = rule.for_batch(pod, batch)
            if self._station is not None:
                self._batch = iter(batch)
            elif rule.parameters.first_come_first_served:
                self._pods = iter(())
