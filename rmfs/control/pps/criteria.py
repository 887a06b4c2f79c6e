"""Criteria for the choice of a pod, set in a controllers file; the highest score wins."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.congestion import CongestionParameters
from rmfs.control.pps.requests import RequestValue, value_of
from rmfs.control.trackers.pod_scores import DemandOnPods, demand
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.pps.candidates import Candidates, PickCandidates
    from rmfs.control.view import View
    from rmfs.world.orders import Order

    Scores = NDArray[np.float64] | NDArray[np.int64]

_OTHER_TIER = 1000.0
"""Deduction from a pod's score if the robot is on another tier, and again if the station is.

It is larger than the number of units that any pod can serve.
"""

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]
Share = Annotated[float, pydantic.Field(ge=0, le=1)]


class PodCriterion(Parameters):
    """Base class of the criteria for the choice of a pod."""

    def prepare(self, view: View) -> None:
        """Request the trackers (shared statistics) that the criterion needs.

        Called when the controller is created.
        """


class RandomCriterion(PodCriterion):
    """Prefers a random pod; by default, pods on the tier of robot and station come first."""

    criterion: Literal["random"] = "random"
    prefer_same_tier: bool = True
    """Whether pods on the tiers of robot and station come first."""

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Return scores drawn uniformly from [0, 1).

        If `prefer_same_tier` is set, the score of a pod is reduced by 1 if the robot is on another
        tier, and by 1 if the station is on another tier.
        """
        scores: Scores = rng.random(len(candidates))
        return scores - candidates.other_tiers() if self.prefer_same_tier else scores


class Nearest(CongestionParameters, PodCriterion):
    """Prefers the pod with the shortest trip from the robot to the pod and on to the station.

    The delay that congestion is expected to cause on both trips can be added to the travel time.
    """

    criterion: Literal["nearest"] = "nearest"
    metric: Metric = "time"
    """Measure of length: `euclidean`, `manhattan` (m), `path` (m along the waypoints) or `time`
    (s)."""
    estimate: bool = True
    """For `time`: whether the time from the robot to the pod is estimated by Manhattan distance."""

    @pydantic.model_validator(mode="after")
    def _seconds_only(self) -> Nearest:
        if self.congestion and self.metric != "time":
            raise ValueError("congestion: needs metric = 'time'")
        return self

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Return minus the travel time in s, or minus the distance in m."""
        if self.metric == "time":
            seconds = _seconds(candidates, self.estimate, estimate_station=False)
            return -seconds - self._delay_s(candidates) if self.congestion else -seconds
        travel, pods = candidates.view.travel, candidates.waypoints()
        robot = travel.robot_waypoint(candidates.robot.index)
        station = candidates.station.waypoint
        from_robot = travel.between(robot, pods, self.metric, loaded=False)
        return -(from_robot + travel.distances_to(station, self.metric)[pods])

    def _delay_s(self, candidates: Candidates) -> NDArray[np.float64] | float:
        """Return the expected delay on the way to each pod and on to the station, shape (n,)."""
        view, pods = candidates.view, candidates.waypoints()
        robot = view.travel.robot_waypoint(candidates.robot.index)
        to_pod = self.delay_s(view, robot, pods)
        return to_pod + self.delay_s(view, candidates.station.waypoint, pods)


class Fill(PodCriterion):
    """Prefers full pods, or empty ones."""

    criterion: Literal["fill"] = "fill"
    prefer_fullest: bool = True
    """Whether full pods come first; otherwise, empty pods do."""
    binary: bool = True
    """Whether pods are only compared with the threshold, not with each other."""
    threshold: Share = 0.7
    """Share of used capacity that separates full pods from empty ones."""

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Return the used share of each pod's capacity, negative if empty pods are preferred.

        With `binary`, return 1 for pods on the preferred side of the threshold, and 0 for others.
        """
        inventory = candidates.view.inventory
        share = inventory.used[candidates.pods] / inventory.capacity[candidates.pods]
        if self.binary:
            side = share > self.threshold if self.prefer_fullest else share < self.threshold
            return side.astype(np.int64)
        return share if self.prefer_fullest else -share


class PickDemand(PodCriterion):
    """Prefers the pod with the most units that orders at stations or in the backlog still need."""

    criterion: Literal["demand"] = "demand"

    def prepare(self, view: View) -> None:
        """Request the tracker that counts the units in demand on each pod."""
        view.trackers.get(DemandOnPods, "unbound")

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Return for each pod the sum over SKUs of min(units on the pod, open requests)."""
        units = candidates.view.trackers.get(DemandOnPods, "unbound").units()
        scores: Scores = units[candidates.pods]
        return scores


class Completeable(PodCriterion):
    """Prefers the pod that completes the most orders of the station."""

    criterion: Literal["completeable"] = "completeable"
    queued: bool = True
    """Whether queued orders count as well."""

    def score(self, candidates: PickCandidates, rng: np.random.Generator) -> Scores:
        """Return the number of orders that each pod completes by serving all open requests."""
        done = candidates.completed()
        flags = done.flags if self.queued else done.flags[: done.assigned]
        scores: Scores = flags.sum(axis=0)
        return scores


class PickWorkAmount(PodCriterion):
    """Prefers the pod for which the work at the station, minus a cost of travel, is greatest.

    The work is the total value of the requests that the pod can serve. `metric` selects the value
    of a request: 1 (`picks`), the time since its order was assigned (`age`), or the lateness of its
    order (`lateness`); time and lateness are divided by the number of the order's open requests
    (`rmfs.control.pps.requests.value_of`). In a controllers file, the names `pile-on`, `age` and
    `lateness` stand for this criterion with the metric `picks`, `age` or `lateness`, respectively.
    """

    criterion: Literal["work-amount"] = "work-amount"
    metric: RequestValue = "picks"
    """Value of a request: `picks` (1), or `age` or `lateness` of its order (s per open request)."""
    only_positive_lateness: bool = False
    """For `lateness`: whether the value of orders that are not late yet is 0 instead of
    negative."""
    time_cost: NotNegative = 1 / 3
    """Cost of a second of travel, in the unit of `metric`: picks, or seconds of age or lateness."""
    completable_boost: NotNegative = 1.0
    """Relative increase in the value of requests of orders that the pod can complete; with 1, they
    count twice."""
    queued_weight: NotNegative = 0.2
    """Value of a request of a queued order, relative to that of a request of an assigned order."""
    boost_queued: bool = True
    """Whether `completable_boost` applies to queued orders, too."""
    estimate_to_pod: bool = True
    """Whether the time from the robot to the pod is estimated by Manhattan distance."""
    estimate_to_station: bool = False
    """Whether the time from the pod to the station is estimated by Manhattan distance."""
    prefer_same_tier: bool = True
    """Whether pods on the tiers of robot and station come first."""

    def score(self, candidates: PickCandidates, rng: np.random.Generator) -> Scores:
        """Return the value of the requests that the pod can serve, minus the cost of travel time.

        If `prefer_same_tier` is set, the score of a pod is reduced if the robot is on another tier,
        and once more if the station is on another tier.
        """
        scores = self._work(candidates)
        if self.time_cost:
            scores = scores - self.time_cost * _seconds(
                candidates, self.estimate_to_pod, self.estimate_to_station
            )
        if self.prefer_same_tier:
            scores = scores - _OTHER_TIER * candidates.other_tiers()
        return scores

    def _work(self, candidates: PickCandidates) -> Scores:
        done = candidates.completed()
        value = {order: self._value(candidates, order) for order in done.orders}
        worth = [value[order] * order.open_units for order in done.orders]
        if self.metric == "picks":
            scores: Scores = candidates.servable_units()
        else:
            scores = _valued(candidates, value)
        scores = scores + self.completable_boost * done.weighed(worth, queued=False)
        if candidates.queued and self.queued_weight:
            scores = scores + self.queued_weight * self._queued_work(candidates, value, worth)
        return scores

    def _queued_work(
        self, candidates: PickCandidates, value: dict[Order, float], worth: list[float]
    ) -> Scores:
        """Return the value of queued orders' requests, with the boost but not the weight."""
        done = candidates.completed()
        completed = done.weighed(worth, queued=True)
        boost = self.completable_boost * self.boost_queued
        if candidates.requests == "assigned-and-completable":
            return (1 + boost) * completed
        if self.metric == "picks":
            return candidates.queued_units() + boost * completed
        return _valued(candidates, value, queued=True) + boost * completed

    def _value(self, candidates: PickCandidates, order: Order) -> float:
        now_s = candidates.view.now_s
        return value_of(order, now_s, self.metric, positive=self.only_positive_lateness)


class WaveWork(PodCriterion):
    """Prefers the pod with the most units for the first wave of the station.

    A wave consists of orders that are due together, as for one truck. The first wave of a station
    contains its late orders and those of its orders that are due next.
    """

    criterion: Literal["wave"] = "wave"
    wave_s: NotNegative = 0.0
    """Orders due within this many seconds after the order that is due next belong to its wave."""

    def score(self, candidates: PickCandidates, rng: np.random.Generator) -> Scores:
        """Return the number of units that the pod has for assigned orders of the first wave."""
        orders = candidates.pick_station.orders.values()
        coming = [order.due_s for order in orders if order.due_s >= candidates.view.now_s]
        last_s = min(coming, default=candidates.view.now_s) + self.wave_s
        return _valued(candidates, {order: float(order.due_s <= last_s) for order in orders})


class BundleWorkAmount(PodCriterion):
    """Prefers the pod for which the most bundles wait at the station.

    With `age`, each bundle is weighted by its waiting time.
    """

    criterion: Literal["work-amount"] = "work-amount"
    age: bool = False
    """Whether bundles are weighted by the time since their assignment; otherwise, equally."""
    prefer_same_tier: bool = True
    """Whether pods on the tiers of robot and station come first."""

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Return the number of bundles waiting for the pod, or their total waiting time in s.

        If `prefer_same_tier` is set, the score of a pod is reduced if the robot is on another tier,
        and once more if the station is on another tier.
        """
        view = candidates.view
        station = candidates.station.number
        if self.age:
            waiting = view.replenishment_stations[station].waiting
            scores: Scores = np.array(
                [
                    sum(view.now_s - bundle.assigned_s for bundle in waiting[pod])
                    for pod in candidates.pods.tolist()
                ]
            )
        else:
            scores = view.bundles_waiting[station][candidates.pods].astype(float)
        if self.prefer_same_tier:
            scores = scores - _OTHER_TIER * candidates.other_tiers()
        return scores


class BundleDemand(PodCriterion):
    """Prefers the pod whose bundles, which wait at the station, are most in demand."""

    criterion: Literal["demand"] = "demand"

    def score(self, candidates: Candidates, rng: np.random.Generator) -> Scores:
        """Return for each pod the sum of min(units, open requests) over the bundles waiting for it.

        For each bundle, the open requests for its SKU are those of all orders.
        """
        view = candidates.view
        station = candidates.station.number
        waiting = view.replenishment_stations[station].waiting
        wanted = demand(view, "unbound").tolist()
        return np.array(
            [
                sum(min(bundle.units, wanted[bundle.sku]) for bundle in waiting[pod])
                for pod in candidates.pods.tolist()
            ]
        )


def _valued(
    candidates: PickCandidates, value: dict[Order, float], queued: bool = False
) -> NDArray[np.float64]:
    """Return the total value of the requests that each pod can serve, shape (C,).

    Of the requests for a SKU, the most valuable are served first.
    """
    station = candidates.pick_station
    pool = station.queued_requests if queued else station.requests
    need = candidates.view.need[station.index]
    total = np.zeros(len(candidates))
    for row, sku in enumerate(candidates.skus):
        waiting = pool.lines.get(sku)
        if not waiting:
            continue
        lines = sorted(waiting, key=lambda line: value[line.order], reverse=True)
        before = int(need[sku]) if queued else 0
        for line in lines:
            taken = np.clip(candidates.have[row] - before, 0, line.open_units)
            total += value[line.order] * taken
            before += line.open_units
    return total


def _seconds(
    candidates: Candidates, estimate_pod: bool, estimate_station: bool
) -> NDArray[np.float64]:
    """Return the travel time in s to each pod and from there to the station, shape (C,)."""
    travel = candidates.view.travel
    pods = candidates.waypoints()
    robot, station = travel.robot_waypoint(candidates.robot.index), candidates.station.waypoint
    if estimate_pod:
        to_pod = travel.estimate_s(robot, pods)
    else:
        to_pod = travel.away(robot, loaded=False)[pods]
    if estimate_station:
        to_station = travel.estimate_s(station, pods)
    else:
        to_station = travel.to(station, loaded=True)[pods]
    seconds: NDArray[np.float64] = to_pod + to_station
    return seconds


_SHORT: dict[str, dict[str, Any]] = {
    "pile-on": {"criterion": "work-amount", "metric": "picks"},
    "age": {"criterion": "work-amount", "metric": "age"},
    "lateness": {"criterion": "work-amount", "metric": "lateness"},
}


def by_name(value: Any) -> Any:
    """Replace the name of a criterion by a table that selects it with default parameters.

    The names `pile-on`, `age` and `lateness`, alone or in a table, are replaced by `work-amount`
    with the metric `picks`, `age` or `lateness`, respectively. Other tables are returned unchanged.
    """
    given = {"criterion": value} if isinstance(value, str) else value
    if isinstance(given, dict) and given.get("criterion") in _SHORT:
        return {**given, **_SHORT[given["criterion"]]}
    return given


PickCriterion = Annotated[
    RandomCriterion | Nearest | Fill | PickDemand | Completeable | PickWorkAmount | WaveWork,
    pydantic.Field(discriminator="criterion"),
    pydantic.BeforeValidator(by_name),
]
BundleCriterion = Annotated[
    RandomCriterion | Nearest | BundleDemand | BundleWorkAmount,
    pydantic.Field(discriminator="criterion"),
    pydantic.BeforeValidator(by_name),
]
