"""TA balanced: every robot works for one station; robots are divided over stations by weight."""

from __future__ import annotations

from math import ceil, inf
from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import BringForBundles, BringForPicks, Park, Rest, TaskDecision
from rmfs.control.problems import Trigger
from rmfs.control.ta import Consult, TaskAllocation
from rmfs.control.ta.balance import deal, reassign, split
from rmfs.control.ta.rest import RestPlaces, RestRule

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class BalancedParameters(Parameters):
    """Parameters of TA balanced."""

    pick_weight: NotNegative = 2.0
    """Weight of pick stations when the robots are divided between the kinds of station."""
    replenishment_weight: NotNegative = 1.0
    """Weight of replenishment stations."""
    reposition_weight: NotNegative = 0.0
    """Weight of repositioning: robots that work for no station."""
    robots_per_station: Annotated[int, pydantic.Field(ge=1)] = 9
    """How many robots may work for one station."""
    period_s: NotNegative = 30.0
    """Seconds between re-balancings, which look at the stations that have work; 0 for never."""
    other_stations: bool = False
    """Whether a pod that has been served may go on to another station."""
    search_radius_m: NotNegative = 8.0
    """Metres to that station at most."""
    rest: RestRule = "middle"
    """Where idle robots wait: near the middle of their tier, or at random."""


class Balanced(TaskAllocation[BalancedParameters]):
    """Divides robots over the stations that have work, and lets each work for its station only.

    A robot that carries a pod goes on with it as long as the pod can serve an open request of the
    robot's station (or, if so wished, of another one near by), then parks it. An empty robot gets
    the pod that PPS chooses; if another robot without work stands beneath that pod, that one gets
    the job and the two change stations. A robot for which there is nothing to do rests.

    Every `period_s`, if other stations have work than before, the robots are divided anew: by
    weight, times the share of the kind's stations that have work; within a kind in turn, stations
    far from the middle of the tier first; what exceeds the limit goes to any station below it.
    Then robots are moved, nearest first.

    Differences from RAWSim-O: the robot that asks does not count towards its station's limit; idle
    robots are asked again when there is new work, not every 5 s.
    """

    parameters_model = BalancedParameters
    subscriptions = frozenset(
        {Trigger.ORDER_ASSIGNED, Trigger.BUNDLE_ASSIGNED, Trigger.POD_AT_HAND}
    )

    def __init__(
        self, parameters: BalancedParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        robots = len(view.robots)
        self._rest = RestPlaces(view, parameters.rest, self.draw)
        self._waypoints = np.array([station.waypoint for station in view.stations])
        self._far_first = _far_first(view, self._waypoints)
        self._station_of = [-1] * robots
        self._works_for = [-1] * robots
        self._workers = [0] * len(view.stations)
        self._searched = [(-1, -1)] * len(view.stations)
        self._active: frozenset[int] = frozenset()
        self._balance(frozenset(range(len(view.stations))))
        self._balance_due_s = view.now_s + parameters.period_s if parameters.period_s else inf

    def next_event_s(self) -> float:
        """When robots are to be divided anew."""
        return self._balance_due_s

    def decide(self, consult: Consult) -> Iterator[TaskDecision]:
        """Yield a task for every robot that asks, and work for robots at rest."""
        if self.view.now_s >= self._balance_due_s:
            self._balance_due_s = self.view.now_s + self.parameters.period_s
            self._balance(frozenset(s.index for s in self.view.stations if s.has_work))
        for robot in list(self.view.asking.values()):
            while robot.task is None:
                task = self._next_task(robot, consult)
                if task is None:
                    break
                yield task
        yield from self._wake(consult)

    def rest_place(self, robot: Robot) -> int:
        """Choose by the rest rule."""
        return self._rest.choose(robot)

    # --- tasks ----------------------------------------------------------------------------------

    def _next_task(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        station = self._station_of[robot.index]
        if robot.pod >= 0:
            return self._go_on(robot, station, consult)
        return self._fetch(robot, station, consult) or self._to_rest(robot)

    def _go_on(self, robot: Robot, station: int, consult: Consult) -> TaskDecision | None:
        """Use a pod that has been served again, or park it."""
        if self._may_work(robot, station) and self.view.can_serve(robot.pod, station):
            return self._bring(robot, robot.pod, station)
        if self.parameters.other_stations:
            stations = self._near_stations(robot)
            if stations:
                return self._bring(robot, robot.pod, consult.next_station(robot, stations))
        place = consult.place_for(robot)
        return Park(robot, place) if place >= 0 else None

    def _near_stations(self, robot: Robot) -> list[int]:
        """Stations within the search radius, on the robot's tier, that its pod can serve."""
        metres = self.view.travel.metres(robot.waypoint, self._waypoints)
        return [
            station.index
            for station in self.view.stations
            if metres[station.index] <= self.parameters.search_radius_m
            and station.tier == robot.tier
            and self._may_work(robot, station.index)
            and self.view.can_serve(robot.pod, station.index)
        ]

    def _fetch(self, robot: Robot, station: int, consult: Consult) -> TaskDecision | None:
        """Find a pod for an empty robot, unless nothing has changed since none was found."""
        if not self._may_work(robot, station):
            return None
        version = self.view.work_version(station)
        if self._searched[station] == version or not self.view.has_open_work(station):
            return None
        pod = consult.pod_for(robot, station)
        if pod < 0:
            self._searched[station] = version
            return None
        storage = self.view.storage
        keeper = storage.kept_by[storage.place_of[pod]]
        if keeper not in (-1, robot.index):
            self._change_stations(robot, self.view.robots[keeper])
            robot = self.view.robots[keeper]
        return self._bring(robot, pod, station)

    def _bring(self, robot: Robot, pod: int, station: int) -> TaskDecision:
        self._count(robot, station)
        kind = BringForPicks if station < len(self.view.pick_stations) else BringForBundles
        return kind(robot, pod, station)

    def _to_rest(self, robot: Robot) -> Rest:
        self._count(robot, -1)
        place = self._rest.choose(robot)
        return Rest(robot, place if place >= 0 else robot.waypoint)

    def _wake(self, consult: Consult) -> Iterator[TaskDecision]:
        """Give work to robots at rest whose station has some that is new."""
        for robot in list(self.view.resting.values()):
            if robot.index in self.view.resting:
                task = self._fetch(robot, self._station_of[robot.index], consult)
                if task is not None:
                    yield task

    # --- who works for which station ------------------------------------------------------------

    def _may_work(self, robot: Robot, station: int) -> bool:
        """Whether the station has fewer workers than its limit, this robot left out."""
        if station < 0:
            return False
        others = self._workers[station] - (self._works_for[robot.index] == station)
        return others < self.parameters.robots_per_station

    def _count(self, robot: Robot, station: int) -> None:
        """Count a robot as worker of a station (-1: of none) from now on."""
        former = self._works_for[robot.index]
        if former >= 0:
            self._workers[former] -= 1
        if station >= 0:
            self._workers[station] += 1
        self._works_for[robot.index] = station

    def _change_stations(self, one: Robot, other: Robot) -> None:
        stations = self._station_of
        stations[one.index], stations[other.index] = stations[other.index], stations[one.index]

    def _balance(self, active: frozenset[int]) -> None:
        if active == self._active:
            return
        self._active = active
        targets = np.array([self.view.robot_target(robot) for robot in self.view.robots])
        distance = np.stack(
            [self.view.travel.metres(waypoint, targets) for waypoint in self._waypoints.tolist()],
            axis=1,
        )
        self._station_of = reassign(self._station_of, self._goals(active), distance)

    def _goals(self, active: frozenset[int]) -> dict[int, int]:
        """How many robots each station with work is to get."""
        given = self.parameters
        order = [station for station in self._far_first if station in active]
        picks = [station for station in order if station < len(self.view.pick_stations)]
        others = [station for station in order if station >= len(self.view.pick_stations)]
        pick_weight = given.pick_weight * len(picks) / max(len(self.view.pick_stations), 1)
        replenishment_weight = (
            given.replenishment_weight * len(others) / max(len(self.view.replenishment_stations), 1)
        )
        for_picks, for_bundles = split(self._station_robots(), pick_weight, replenishment_weight)
        goals = dict.fromkeys(order, 0)
        left = deal(for_picks, picks, given.robots_per_station, goals)
        left += deal(for_bundles, others, given.robots_per_station, goals)
        deal(left, order, given.robots_per_station, goals)
        return goals

    def _station_robots(self) -> int:
        """How many robots work for stations at all."""
        given = self.parameters
        weight = given.pick_weight + given.replenishment_weight
        total = weight + given.reposition_weight
        return ceil(weight / total * len(self.view.robots)) if total > 0 else 0


def _far_first(view: View, waypoints: NDArray[np.int64]) -> list[int]:
    """Stations, those far from the middle of their tier first, ties by number."""
    layout = view.layout
    tiers = [layout.tiers[tier] for tier in layout.tier[waypoints].tolist()]
    x = layout.x_m[waypoints] - np.array([tier.length_m / 2 for tier in tiers])
    y = layout.y_m[waypoints] - np.array([tier.width_m / 2 for tier in tiers])
    far_first: list[int] = np.argsort(-(x * x + y * y), kind="stable").tolist()
    return far_first
