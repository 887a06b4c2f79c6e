"""Criteria for choosing the next station of a carried pod; the highest score wins."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.pps.criteria import by_name
from rmfs.control.pps.requests import RequestValue, value_of
from rmfs.control.travel import Metric
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class RandomNextStation(Parameters):
    """Prefers a random station."""

    criterion: Literal["random"] = "random"

    def score(
        self, view: View, robot: Robot, stations: Sequence[int], rng: np.random.Generator
    ) -> NDArray[np.float64]:
        """Return scores drawn uniformly from [0, 1)."""
        return rng.random(len(stations))


class NearestNextStation(Parameters):
    """Prefers the station nearest to the robot."""

    criterion: Literal["nearest"] = "nearest"
    metric: Metric = "euclidean"
    """Measure of distance: `euclidean`, `manhattan` (m), `path` (m along the waypoints) or `time`
    (s)."""

    def score(
        self, view: View, robot: Robot, stations: Sequence[int], rng: np.random.Generator
    ) -> NDArray[np.float64]:
        """Return minus the distance in m, or minus the travel time in s."""
        waypoints = np.array([view.stations[station].waypoint for station in stations])
        scores: NDArray[np.float64] = -view.travel.between(robot.waypoint, waypoints, self.metric)
        return scores


class MostWork(Parameters):
    """Prefers the station with the most work for the pod."""

    criterion: Literal["work-amount"] = "work-amount"
    metric: RequestValue = "picks"
    """Value of a request: `picks` (1), or `age` or `lateness` of its order (s per open request)."""
    only_positive_lateness: bool = False
    """For `lateness`: whether the value of orders that are not late yet is 0 instead of
    negative."""
    bundle_age: bool = False
    """Whether bundles are weighted by the time since their assignment; otherwise, equally."""

    def score(
        self, view: View, robot: Robot, stations: Sequence[int], rng: np.random.Generator
    ) -> NDArray[np.float64]:
        """Return the amount of work for the pod at each station.

        At a pick station, this is the value of the requests that the pod can serve; at a
        replenishment station, the number of bundles that wait for the pod or, with `bundle_age`,
        their total waiting time in s.
        """
        return np.array([self._work(view, robot.pod, station) for station in stations], float)

    def _work(self, view: View, pod: int, station: int) -> float:
        target = view.stations[station]
        if isinstance(target, PickStation):
            return self._picks(view, pod, target)
        bundles = target.waiting.get(pod, [])
        if self.bundle_age:
            return sum(view.now_s - bundle.assigned_s for bundle in bundles)
        return len(bundles)

    def _picks(self, view: View, pod: int, station: PickStation) -> float:
        """Return the total value of the requests that the pod can serve.

        Of the requests for a SKU, the most valuable are served first.
        """
        total = 0.0
        for sku, waiting in station.requests.lines.items():
            left = view.inventory.available.item(sku, pod)
            if not left:
                continue
            valued = [
                (
                    value_of(
                        line.order, view.now_s, self.metric, positive=self.only_positive_lateness
                    ),
                    line.open_units,
                )
                for line in waiting
            ]
            for value, units in sorted(valued, reverse=True):
                served = min(left, units)
                total += value * served
                left -= served
        return total


NextStationCriterion = Annotated[
    RandomNextStation | NearestNextStation | MostWork,
    pydantic.Field(discriminator="criterion"),
    pydantic.BeforeValidator(by_name),
]
