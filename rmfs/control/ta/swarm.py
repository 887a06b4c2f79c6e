"""TA swarm: a station attracts more robots the more work it has and the nearer it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.decisions import Prepare, TaskDecision
from rmfs.control.ta.solo import Solo, SoloParameters
from rmfs.control.ta.stations import (
    bring,
    keeper_of,
    near_by,
    station_of_task,
    waypoints,
)

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator

    from numpy.typing import NDArray

    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class SwarmParameters(SoloParameters):
    """Parameters of TA swarm."""

    work_limit: Annotated[int, pydantic.Field(ge=1)] = 6
    """Maximum number of orders or bundles of a station that count for its stimulus. A station
    attracts robots only while fewer than this number are matched with it."""
    threshold_weight: NotNegative = 1.0
    """Weight (alpha) of T^2, where T is half of `work_limit`, rounded down. The higher the weight,
    the more stimulus a station needs to attract robots, at any distance."""
    distance_weight: NotNegative = 1.0
    """Weight (beta) of the squared Manhattan distance, in m, from robot to station. The higher the
    weight, the more the robots prefer near stations."""
    growth: Annotated[float, pydantic.Field(ge=1, allow_inf_nan=False)] = 1.2
    """Factor by which the multiplier of a station's stimulus grows each time another station is
    drawn."""
    growth_limit: Annotated[float, pydantic.Field(ge=1, allow_inf_nan=False)] = 30.0
    """Maximum of the multiplier of a station's stimulus."""
    rest_share: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.8
    """Robots may draw rest instead of a station if more than this share of the stations has no
    stimulus."""
    other_stations: bool = False
    """Whether a robot may take its pod to another station nearby when the present station has no
    more work for the pod."""
    search_radius_m: NotNegative = 5.0
    """With `other_stations`, maximum Euclidean distance, in m, from the robot to the other
    station."""


class Swarm(Solo[SwarmParameters]):
    """Lets each robot without a pod draw a station, for which PPS chooses a pod.

    A station's stimulus s is max(min(n, `work_limit`) - m, 0) times the station's multiplier. Here
    n is the number of orders or bundles at the station, and m the number of robots matched with it:
    a robot is matched with the station for which it fetches or carries a pod, until it has stored
    the pod. A station is drawn with a probability proportional to its weight
    s^2 / (s^2 + alpha T^2 + beta d^2), where alpha is `threshold_weight`, beta is
    `distance_weight`, T is half of `work_limit`, rounded down, and d is the Manhattan distance in m
    from the robot to the station. Then the multipliers of the drawn station and of all stations
    without stimulus are set to 1; the others are multiplied by `growth`, up to `growth_limit`.

    Let S be the number of stations, and let R be `rest_share` times S, rounded. If the number of
    stations without stimulus exceeds R by e, the robot can also draw rest instead of a station; the
    weight of rest is e^3 / (S - R)^3. If rest is drawn, no multiplier grows.
    """

    parameters_model = SwarmParameters

    def __init__(self, parameters: SwarmParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._waypoints = waypoints(view)
        self._multiplier = np.ones(len(view.stations))
        self._matched = [station_of_task(robot) for robot in view.robots]

    def task_for(self, robot: Robot, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Yield a task for the pod that the robot carries.

        If the robot carries no pod, it works for a station that is drawn at random. If no station
        has work, the robot rests.
        """
        if robot.pod < 0:
            yield self.work_for(robot, consult) or self.to_rest(robot)
            return
        station = self._next_station(robot, consult)
        if station >= 0:
            self._matched[robot.index] = station
            yield bring(self.view, robot, robot.pod, station)
        else:
            yield from self.park(robot, consult)

    def work_for(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Draw a station and find a pod to bring to it; None if rest is drawn or no pod fits."""
        self._matched[robot.index] = -1
        station = self._draw_station(robot)
        if station < 0 or not self.view.has_open_work(station):
            return None
        pod = consult.pod_for(robot, station)
        if pod < 0:
            return None
        chosen = keeper_of(self.view, robot, pod)
        self._matched[chosen.index] = station
        return bring(self.view, chosen, pod, station)

    def finds_like(self, robot: Robot) -> Hashable:
        """Return the robot's number as the key of its group, as each robot draws for itself."""
        return robot.index

    def _next_station(self, robot: Robot, consult: Consult) -> int:
        """Return the station where a carried pod is served next; -1 if it is to be parked."""
        matched = self._matched[robot.index]
        if matched < 0:
            matched = self._draw_station(robot)
        if matched >= 0 and consult.serves(robot.pod, matched):
            return matched
        if self.parameters.other_stations:
            everywhere = range(len(self.view.stations))
            radius_m = self.parameters.search_radius_m
            stations = near_by(self.view, robot, radius_m, everywhere, consult)
            if stations:
                return consult.next_station(robot, stations)
        return -1

    def _draw_station(self, robot: Robot) -> int:
        """Draw a station, or -1 for rest, and change the multipliers."""
        given = self.parameters
        stimulus = self._stimulus()
        where = self.view.travel.robot_waypoint(robot.index)
        distance = self.view.travel.manhattan_metres(where, self._waypoints)
        threshold = given.work_limit // 2
        squared = stimulus * stimulus
        resistance = given.threshold_weight * threshold**2 + given.distance_weight * (
            distance * distance
        )
        attracts = stimulus > 0
        weights = np.zeros(len(stimulus) + 1)
        weights[:-1][attracts] = squared[attracts] / (squared + resistance)[attracts]
        weights[-1] = self._rest_weight(int((~attracts).sum()))
        chosen = self._draw_by(weights)
        self._multiplier[~attracts] = 1.0
        if chosen == len(stimulus):
            return -1
        grown = np.minimum(self._multiplier[attracts] * given.growth, given.growth_limit)
        self._multiplier[attracts] = grown
        self._multiplier[chosen] = 1.0
        return chosen

    def _stimulus(self) -> NDArray[np.float64]:
        """How much each station attracts robots, shape (S,)."""
        view = self.view
        for charger in view.recovery_stations:
            for robot in charger.tasks:  # sent there by CA, after storing its pod
                self._matched[robot] = -1
        work = [len(station.orders) for station in view.pick_stations]
        work += [station.bundles for station in view.replenishment_stations]
        matched = np.bincount([s for s in self._matched if s >= 0], minlength=len(work))
        missing = np.minimum(work, self.parameters.work_limit) - matched
        stimulus: NDArray[np.float64] = np.maximum(missing, 0) * self._multiplier
        return stimulus

    def _rest_weight(self, unattractive: int) -> float:
        stations = len(self.view.stations)
        threshold = round(self.parameters.rest_share * stations)
        excess = unattractive - threshold
        return (excess / (stations - threshold)) ** 3 if excess > 0 else 0.0

    def _draw_by(self, weights: NDArray[np.float64]) -> int:
        """Draw a position by weight; the last one if all weights are 0."""
        ends = np.cumsum(weights)
        if ends[-1] <= 0:
            return len(weights) - 1
        return int(np.searchsorted(ends, float(self.rng.random()) * ends[-1], side="right"))
