"""TA dispatch: assigns robots to stations by travel times, due times and (optionally) queues."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from rmfs.control.asks import Answer, Ask
from rmfs.control.congestion import CongestionParameters
from rmfs.control.decisions import Park
from rmfs.control.pps.candidates import pick_candidates, replenishment_candidates
from rmfs.control.ta.stations import bring, keeper_of
from rmfs.solvers.control.answers import answer
from rmfs.solvers.control.tasks.asking import Asking, NotNegative, TaskParameters
from rmfs.solvers.models.tasks import balance, matching
from rmfs.solvers.models.tasks.balance import Balance
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.control.asks import Call
    from rmfs.control.decisions import Prepare, TaskDecision
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

Method = Literal["balance", "matching", "greedy"]


@dataclass(frozen=True)
class Question:
    """Robots, tasks of bringing pods to stations, and the method that assigns robots to tasks."""

    data: Balance
    method: str


def solve(question: Question) -> Answer:
    """Assign robots to tasks; the answer has the `robot` of each task, shape (T,), -1 for none."""
    data = question.data
    if question.method == "matching":
        found = matching.solve(data.pairs)
    else:
        found = balance.solve(data, "greedy" if question.method == "greedy" else "flow")
    return answer(found, None if found.values is None else {"robot": found.values})


@dataclass(frozen=True)
class Memo:
    """The objects behind the indices of a question.

    Attributes
    ----------
    station
        Station of each task.
    own
        Whether each task is for a pod that a robot already carries.
    """

    robots: list[Robot]
    station: list[int]
    own: list[bool]


class DispatchParameters(CongestionParameters, TaskParameters):
    """Parameters of TA dispatch."""

    method: Method = "balance"
    """Solution method: `matching` (considers travel and due times), `balance` (also considers
    queues), or `greedy` (as `balance`, but tasks are assigned one after another, each to the robot
    that arrives first)."""
    pick_value_s: NotNegative = 300.0
    """Value of bringing a pod to a pick station, in seconds of robot time; a task that costs more
    is left out."""
    bundle_value_s: NotNegative = 300.0
    """Value of bringing a pod to a replenishment station, in seconds of robot time; a task that
    costs more is left out."""
    service_s: NotNegative = 60.0
    """Estimated service time, in seconds, of each pod at a station or on its way there. A further
    pod is expected to wait for all of these pods."""
    late_weight: NotNegative = 0.02
    """Cost of a second of lateness of an order, in seconds of travel."""
    empty_battery_s: NotNegative = 0.0
    """Travel time, in seconds, that is added for a robot with an empty battery; for other robots,
    the addition is proportional to the missing charge. Robots with more charge are therefore
    preferred."""


class DispatchControl(Asking[DispatchParameters]):
    """Assigns robots to stations; PPS chooses the pods that they bring.

    There are two kinds of tasks: to take a carried pod to a station that it can serve, and to bring
    a pod from storage to a station with work. The number of tasks of the second kind at a station
    is the least of three numbers: the number of robots without a pod, the number of open requests
    or waiting bundles of the station, and the number of further robots that may come to the station
    (`robots_per_station`). With the method `matching`, the sum of travel time and weighted lateness
    of orders is minimised (linear assignment). With the method `balance`, waiting behind other pods
    counts as well (minimum-cost flow). Tasks that are not worth the trip are left out; a robot
    without a task stores its pod if it carries one, and otherwise rests.

    As PPS chooses the pod only later, the time that a robot needs to bring a pod is estimated as
    the mean over all pods that the station could use. The delay that congestion is expected to
    cause can be added to this time (`congestion`).
    """

    parameters_model = DispatchParameters
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.tasks.dispatch",)

    def __init__(
        self, parameters: DispatchParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        parameters.prepare(view)

    def question(self, robots: Sequence[Robot], consult: Consult) -> Ask[Question]:
        """Return the problem of assigning robots to tasks."""
        empty = [row for row, robot in enumerate(robots) if robot.pod < 0]
        station: list[int] = []
        own: list[bool] = []
        arrive: list[NDArray[np.float64]] = []
        for row, robot in enumerate(robots):
            if robot.pod >= 0:
                for number, way_s in self._goes_on(robot, consult):
                    column = np.full(len(robots), np.inf)
                    column[row] = way_s
                    station.append(number)
                    own.append(True)
                    arrive.append(column)
        for target in self.view.stations:
            column = self._to_station(robots, empty, target.index)
            copies = min(len(empty), self.may_come(target.index), self._wanted(target.index))
            if np.isfinite(column).any():
                station += [target.index] * copies
                own += [False] * copies
                arrive += [column] * copies
        data = self._balance(len(robots), station, own, arrive)
        sizes = {"robots": len(robots), "tasks": len(station)}
        memo = Memo(list(robots), station, own)
        return Ask(solve, Question(data, self.parameters.method), sizes, memo)

    def carry_out(self, call: Call, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Let robots bring pods to stations; robots without a task store their pod, or rest."""
        assert call.solution is not None
        memo: Memo = call.ask.memo
        view = self.view
        told = np.asarray(call.solution["robot"])
        for task in call.left("tasks", np.flatnonzero(told >= 0).tolist()):
            robot, station = memo.robots[int(told[task])], memo.station[task]
            free = robot.task is None or robot.index in view.resting
            if memo.own[task]:
                if free and robot.pod >= 0 and consult.serves(robot.pod, station):
                    yield bring(view, robot, robot.pod, station)
                    continue
            elif free and robot.pod < 0 and self.may_come(station):
                pod = consult.pod_for(robot, station)
                if pod >= 0:
                    yield bring(view, keeper_of(view, robot, pod), pod, station)
                    continue
            call.stale += 1
        for robot in call.left("robots", memo.robots):
            if robot.task is None and robot.index in view.asking:
                place = consult.place_for(robot) if robot.pod >= 0 else -1
                if place >= 0:
                    yield Park(robot, place)
                elif robot.pod < 0:
                    yield self.to_rest(robot)

    def _goes_on(self, robot: Robot, consult: Consult) -> Iterator[tuple[int, float]]:
        """Yield the stations that a carried pod can serve, with the trip time."""
        away_s = self.view.travel.away(robot.waypoint, loaded=True)
        for station in self.view.stations:
            here = station.index == robot.station
            if (here or self.may_come(station.index)) and consult.serves(robot.pod, station.index):
                yield station.index, 0.0 if here else float(away_s[station.waypoint])

    def _to_station(
        self, robots: Sequence[Robot], empty: list[int], number: int
    ) -> NDArray[np.float64]:
        """Return the time until each robot has brought a pod (mean over pods); inf if it cannot."""
        view, column = self.view, np.full(len(robots), np.inf)
        if not empty or not view.has_open_work(number):
            return column
        station = view.stations[number]
        if isinstance(station, PickStation):
            pods = pick_candidates(view, robots[empty[0]], station).pods
        else:
            pods = replenishment_candidates(view, robots[empty[0]], station).pods
        if len(pods):
            at = view.storage.pod_waypoint[pods]
            bring_s = view.travel.to(view.stations[number].waypoint, loaded=True)[at]
            bring_s = bring_s + self.parameters.delay_s(view, station.waypoint, at)
            for row in empty:
                here = robots[row].waypoint
                reach_s = view.travel.estimate_s(here, at)
                reach_s += self.parameters.delay_s(view, here, at)
                column[row] = float(np.mean(reach_s + bring_s)) + self._low_s(robots[row])
        return column

    def _low_s(self, robot: Robot) -> float:
        """Return the additional travel time attributed to a robot because of its battery."""
        batteries, empty_s = self.view.batteries, self.parameters.empty_battery_s
        if batteries is None or not empty_s:
            return 0.0
        return empty_s * (1 - batteries.share(robot.index))

    def _wanted(self, number: int) -> int:
        """Return the maximum number of pods that a station could use."""
        target = self.view.stations[number]
        if isinstance(target, PickStation):
            return target.requests.units + target.queued_requests.units
        return len(target.waiting)

    def _pace(self, station: int) -> float:
        """Return the factor by which the current picker changes the service time of a pod."""
        stations = self.view.layout.pick_stations
        if self.view.staff is None or station >= len(stations):
            return 1.0
        full_s = stations[station].unit_transfer_s
        return self.view.unit_s(station) / full_s if full_s else 1.0

    def _balance(
        self,
        robots: int,
        station: list[int],
        own: list[bool],
        arrive: list[NDArray[np.float64]],
    ) -> Balance:
        view, given = self.view, self.parameters
        picks = [isinstance(view.stations[s], PickStation) for s in station]
        value = [given.pick_value_s if pick else given.bundle_value_s for pick in picks]
        due_s = [
            min((order.due_s for order in target.orders.values()), default=np.inf) - view.now_s
            for target in view.pick_stations
        ]
        queue = [len(target.tasks) for target in view.stations]
        here = np.bincount(
            [s for s, o in zip(station, own, strict=True) if o], minlength=len(queue)
        )
        return Balance(
            arrive_s=np.stack(arrive, axis=1) if arrive else np.zeros((robots, 0)),
            leave_s=np.array(value, np.float64),
            due_s=np.array(
                [due_s[s] if pick else np.inf for s, pick in zip(station, picks, strict=True)],
                np.float64,
            ),
            station=np.array(station, np.int64),
            queue=np.array(queue),
            service_s=np.array([given.service_s * self._pace(s) for s in range(len(queue))]),
            room=np.array([self.may_come(s) for s in range(len(queue))]) + here,
            late_weight=given.late_weight,
        )
