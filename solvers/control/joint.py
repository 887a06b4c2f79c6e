"""Base of joint TA controllers, with the rules for decisions that their models leave open."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, TypeVar

import numpy as np

from rmfs.control.asks import By
from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignLines, AssignOrder, BringForBundles, BringForPicks, Rest
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.problems import Problem, Trigger
from rmfs.control.ta import WORK, TaskAllocation
from rmfs.control.ta.rest import RestPlaces, RestRule
from rmfs.control.ta.stations import keeper_of
from rmfs.world.tasks import ReplenishTask

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import Any

    from rmfs.control.view import View
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation

P = TypeVar("P", bound=Parameters)


class JointAllocation(TaskAllocation[P]):
    """A TA controller whose model assigns orders and pods to pick stations, and robots to the pods.

    Other decisions are made by rules: for replenishment, a robot brings a pod chosen by PPS
    lexicographic to the nearest replenishment station with work; idle robots rest where the rest
    rule `rest` sends them. Answers are stored in a plan, which this controller carries out without
    consulting other controllers.
    """

    decides: ClassVar[frozenset[Problem]] = frozenset({Problem.POA, Problem.PPS})
    subscriptions = WORK | {
        Trigger.NEW_ORDER,
        Trigger.ORDER_CUT,
        Trigger.ORDER_COMPLETED,
        Trigger.BUNDLE_STORED,
        Trigger.STATION_SWITCHED,
        Trigger.POD_AT_STATION,
    }
    hears = frozenset(
        {Trigger.NEW_ORDER, Trigger.ORDER_CUT, Trigger.POD_AT_STATION, Trigger.ROBOT_FREE}
    )
    goes_on = True

    def __init__(self, parameters: P, view: View, rng: np.random.Generator, rest: RestRule) -> None:
        super().__init__(parameters, view, rng)
        self._heuristic = Lexicographic(Lexicographic.parameters_model(), view, rng)
        self._rest = RestPlaces(view, rest, self.draw)

    def is_modelled(self, decision: Any) -> bool:
        """Whether a decision is of a kind that the model makes.

        The model assigns orders or their lines to pick stations, and sends robots without a pod to
        fetch pods for picks.
        """
        if isinstance(decision, BringForPicks):
            return decision.robot.pod < 0
        return isinstance(decision, AssignOrder | AssignLines)

    def _free_robots(self) -> list[Robot]:
        """Return the robots that rest, or that need a task and carry no pod, in order of index."""
        asking, resting = self.view.asking, self.view.resting
        return [
            robot
            for robot in self.view.robots
            if robot.index in resting or (robot.index in asking and robot.pod < 0)
        ]

    def _nearest(self, robots: Sequence[Robot], pod: int) -> Robot:
        at = self.view.storage.pod_waypoint[[pod]]
        travel = self.view.travel
        return min(robots, key=lambda r: (travel.estimate_s(r.waypoint, at)[0], r.index))

    def _at_bundles(self) -> int:
        """Return the number of robots working for replenishment stations."""
        return sum(isinstance(robot.task, ReplenishTask) for robot in self.view.robots)

    def _replenish(self, most: int) -> Iterator[By[BringForBundles]]:
        """Send at most this many robots for bundles, each to the nearest station with work."""
        view = self.view
        waiting = [s for s in view.replenishment_stations if view.has_open_work(s.index)]
        for robot in self._free_robots() if waiting else ():
            if most <= 0:
                return
            metres = view.travel.metres(robot.waypoint, np.array([s.waypoint for s in waiting]))
            for number in np.argsort(metres, kind="stable").tolist():
                station = waiting[number]
                pod = self._heuristic.replenishment_pod(robot, station)
                if pod >= 0:
                    yield By(BringForBundles(keeper_of(view, robot, pod), pod, station.index), None)
                    most -= 1
                    break

    def _to_rest(self, robot: Robot) -> Rest:
        place = self._rest.choose(robot)
        return Rest(robot, place if place >= 0 else robot.waypoint)

    def rest_place(self, robot: Robot) -> int:
        """Choose the resting place of a robot by the rest rule."""
        return self._rest.choose(robot)

    # --- for the consult ------------------------------------------------------------------------

    def serves(self, pod: int, station: int) -> bool:
        """Whether a pick or replenishment station has work for a pod."""
        return self._heuristic.serves(pod, station)

    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Return -1 (no pod), because the plan of this controller contains the tasks for picks."""
        return -1

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose the pod by PPS lexicographic."""
        return self._heuristic.replenishment_pod(robot, station)

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose the next station of a carried pod by PPS lexicographic."""
        return self._heuristic.next_station(robot, stations)
