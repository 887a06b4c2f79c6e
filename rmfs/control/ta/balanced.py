"""TA balanced: divides robots among stations by weight; each robot works for its station."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.decisions import Reposition, TaskDecision
from rmfs.control.ta.balance import deal, split
from rmfs.control.ta.station_teams import NotNegative, StationTeams, TeamParameters
from rmfs.control.ta.stations import by_kind, keeper_of, near_by

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.ta import Consult
    from rmfs.world.robots import Robot


class BalancedParameters(TeamParameters):
    """Parameters of TA balanced."""

    pick_weight: NotNegative = 2.0
    """Weight of pick stations when robots are divided between the kinds of station."""
    replenishment_weight: NotNegative = 1.0
    """Weight of replenishment stations when robots are divided between the kinds of station."""
    reposition_weight: NotNegative = 0.0
    """Weight of repositioning, that is, of robots that have no station and only move idle pods."""
    robots_per_station: Annotated[int, pydantic.Field(ge=1)] = 9
    """Maximum number of robots working for one station."""
    search_all: bool = False
    """Whether a robot may take work of any station, the nearest first, instead of only that of its
    own station."""
    other_stations: bool = False
    """Whether a robot may take its pod to another station nearby when the present station has no
    more work for the pod."""
    search_radius_m: NotNegative = 8.0
    """With `other_stations`, maximum Euclidean distance, in m, from the robot to the other
    station."""
    reposition_before_rest: bool = True
    """Whether robots without work move idle pods, if repositioning finds a move."""


class Balanced(StationTeams[BalancedParameters]):
    """Divides robots among stations with work; by default, a robot works only for its station.

    A robot continues with the pod it carries as long as the pod has work at the robot's station
    (or, with `other_stations`, at another station nearby), and then parks the pod. A robot without
    a pod brings the pod that PPS chooses. If another robot without work stands beneath that pod,
    the other robot brings it, and the two robots exchange their stations. A robot for which there
    is no work moves an idle pod, if repositioning finds one, or rests.

    Every `period_s` seconds, if the set of stations with work has changed, the robots are
    redistributed. The share of robots that get no station is `reposition_weight` divided by the sum
    of the three weights; their number is rounded down. The others are divided between the two kinds
    of station in proportion to the weight of each kind times the share of its stations that have
    work. Within a kind, stations get one robot each in turn, up to `robots_per_station`; the
    stations farthest from the middle of the tier come first. Robots left over go to stations of
    either kind that are still below this limit. Robots are reassigned by distance, the nearest pair
    of robot and station first. If no station had work at the last redistribution, the next one
    takes place as soon as a station has work.

    A robot works for a station only if fewer than `robots_per_station` other robots do.
    """

    parameters_model = BalancedParameters

    def stations_now(self) -> frozenset[int]:
        """Return the stations that have work."""
        return frozenset(station.index for station in self.view.stations if station.has_work)

    def goals(self, active: frozenset[int]) -> dict[int, int]:
        """Return the number of robots that each of the given stations should have."""
        given = self.parameters
        order = [station for station in self._far_first if station in active]
        picks, others = by_kind(self.view, order)
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

    def may_work(self, robot: Robot, station: int) -> bool:
        """Return whether fewer than `robots_per_station` other robots work for a station."""
        return station >= 0 and self.workers(station, robot) < self.parameters.robots_per_station

    def stations_for(self, robot: Robot) -> Sequence[int]:
        """Return the robot's station or, with `search_all`, all stations, nearest first.

        If the robot has no station, the result is empty in both cases.
        """
        own = super().stations_for(robot)
        if not own or not self.parameters.search_all:
            return own
        metres = self.view.travel.metres(robot.waypoint, self._waypoints)
        nearest_first: list[int] = np.argsort(metres, kind="stable").tolist()
        return nearest_first

    def go_elsewhere(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Return the task of bringing the carried pod to a station nearby; PPS chooses the station.

        The result is None if `other_stations` is false, or if no station nearby has work for the
        pod and may get another robot.
        """
        if not self.parameters.other_stations:
            return None
        among = [s.index for s in self.view.stations if self.may_work(robot, s.index)]
        stations = near_by(self.view, robot, self.parameters.search_radius_m, among, consult)
        if not stations:
            return None
        return self.bring(robot, robot.pod, consult.next_station(robot, stations))

    def looks_elsewhere(self) -> bool:
        """Return whether robots may work for all stations (`search_all`)."""
        return self.parameters.search_all

    def may_be_moved(self, consult: Consult) -> bool:
        """Return whether robots without work may move idle pods."""
        given = self.parameters
        moves = given.reposition_before_rest or given.reposition_weight > 0
        return moves and consult.may_move()

    def instead_of_rest(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Return the task of moving an idle pod; None if not allowed, or if no move is found."""
        given = self.parameters
        only_moves = given.reposition_weight > 0 and self._station_of[robot.index] < 0
        if not (given.reposition_before_rest or only_moves):
            return None
        move = consult.move_for(robot)
        if move is None:
            return None
        chosen = keeper_of(self.view, robot, move.pod)
        self.count(chosen, -1)
        return Reposition(chosen, move.pod, move.place)

    def _station_robots(self) -> int:
        """Return the number of robots that get a station."""
        given = self.parameters
        weight = given.pick_weight + given.replenishment_weight
        total = weight + given.reposition_weight
        # the tolerance is for weights such as 0.1, which binary numbers only approximate
        return ceil(weight / total * len(self.view.robots) - 1e-9) if total > 0 else 0
