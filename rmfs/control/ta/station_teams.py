"""Base class of TA rules in which every robot works for one station at a time."""

from __future__ import annotations

from abc import abstractmethod
from math import inf
from typing import TYPE_CHECKING, Annotated, TypeVar

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import Park, Rest, TaskDecision
from rmfs.control.ta import Consult, TaskAllocation
from rmfs.control.ta.balance import reassign
from rmfs.control.ta.rest import RestPlaces, RestRule
from rmfs.control.ta.stations import bring, far_first, keeper_of, station_of_task, waypoints
from rmfs.world.news import Follower

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.control.view import View
    from rmfs.world.robots import Robot

NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class TeamParameters(Parameters):
    """Parameters of rules in which every robot works for one station at a time."""

    period_s: NotNegative = 30.0
    """Time, in seconds, between redistributions of the robots; 0: the robots are never
    redistributed."""
    rest: RestRule = "middle"
    """Storage location where an idle robot waits: the one nearest to the middle of its tier
    (`middle`), the one nearest to the robot (`nearest`), or one drawn at random (`random`); if
    possible, beneath a stored pod."""


P = TypeVar("P", bound=TeamParameters)


class StationTeams(TaskAllocation[P]):
    """Assigns each robot to a station and gives it work for this station.

    A robot continues with the pod it carries as long as the pod can serve the robot's station, and
    then parks the pod. A robot without a pod brings the pod that PPS chooses. If another robot
    without work stands beneath that pod, the other robot brings it, and the two robots exchange
    their stations. A robot without work rests, and gets work as soon as there is any.

    Every `period_s`, if the result of `stations_now` has changed, robots are reassigned to meet
    `goals`: a station with too few robots gets robots that have no station or whose station has too
    many, the nearest pair of robot and station first. If `stations_now` returned no station the
    last time, reassignment does not wait for the end of the period: it takes place as soon as a
    station should have robots.
    """

    def __init__(self, parameters: P, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        stations = len(view.stations)
        self._rest = RestPlaces(view, parameters.rest, self.draw)
        self._waypoints = waypoints(view)
        self._far_first = far_first(view)
        self._station_of = [-1] * len(view.robots)
        self._works_for = [station_of_task(robot) for robot in view.robots]
        self._workers = [self._works_for.count(station) for station in range(stations)]
        self._searched: list[tuple[int, ...]] = [(-1, -1)] * stations
        self._with_work: set[int] = set()
        self._work_news = Follower(view.work_news)
        self._active: frozenset[int] = frozenset()
        self._balance(self.first_stations())
        self._balance_due_s = view.now_s + parameters.period_s if parameters.period_s else inf

    # --- what the rules say ---------------------------------------------------------------------

    @abstractmethod
    def stations_now(self) -> frozenset[int]:
        """Return the stations that should have robots."""

    @abstractmethod
    def goals(self, active: frozenset[int]) -> dict[int, int]:
        """Return the number of robots that each of the given stations should have."""

    def first_stations(self) -> frozenset[int]:
        """Return the stations that should have robots when the rule is installed."""
        return frozenset(range(len(self.view.stations)))

    def may_work(self, robot: Robot, station: int) -> bool:
        """Return whether a robot may now get work for a station."""
        return station >= 0

    def stations_for(self, robot: Robot) -> Sequence[int]:
        """Return the stations for which a robot may work; the first one with work is chosen."""
        station = self._station_of[robot.index]
        return (station,) if station >= 0 else ()

    def go_elsewhere(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Find a task at another station for a carried pod; None if the pod is to be parked."""
        return None

    def instead_of_rest(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Find a task for a robot that has no work at any of its stations (`stations_for`).

        Return None if the robot is to rest.
        """
        return None

    def may_be_moved(self, consult: Consult) -> bool:
        """Return whether `instead_of_rest` may find a task for some robot now."""
        return True

    def looks_elsewhere(self) -> bool:
        """Return whether `stations_for` may return stations other than the robot's own."""
        return True

    # --- tasks ----------------------------------------------------------------------------------

    def next_event_s(self) -> float:
        """Return the simulated time in s at which robots may next be reassigned; inf if never."""
        return self._balance_due_s

    def decide(self, consult: Consult) -> Iterator[TaskDecision]:
        """Yield a task for every robot that needs one, and work for robots at rest."""
        self._count_visitors()
        if self.view.now_s >= self._balance_due_s:
            self._balance_due_s = self.view.now_s + self.parameters.period_s
            self._balance(self.stations_now())
        elif not self._active and self.parameters.period_s:
            # nobody has a station: do not let new work wait for the end of the period
            self._balance(self.stations_now())
        for robot in list(self.view.asking.values()):
            while robot.task is None:
                task = self._next_task(robot, consult)
                if task is None:
                    break
                yield task
        yield from self._wake(consult)

    def rest_place(self, robot: Robot) -> int:
        """Choose the waypoint where a robot rests, by the parameter `rest`; -1 if there is none."""
        return self._rest.choose(robot)

    def _next_task(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        if robot.pod >= 0:
            return self._go_on(robot, consult)
        return (
            self._fetch(robot, consult)
            or self.instead_of_rest(robot, consult)
            or self._to_rest(robot)
        )

    def _go_on(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Find further work for a carried pod, or park it."""
        for station in self.stations_for(robot):
            if self.may_work(robot, station) and consult.serves(robot.pod, station):
                return self.bring(robot, robot.pod, station)
        task = self.go_elsewhere(robot, consult)
        if task is not None:
            return task
        place = consult.place_for(robot)
        return Park(robot, place) if place >= 0 else None

    def _fetch(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Find a pod for a robot without one.

        A station for which no pod was found is searched again only after its work has changed.
        """
        for station in self.stations_for(robot):
            if not self.may_work(robot, station) or not self.view.has_open_work(station):
                continue
            version = self.view.work_version(station)
            if self._searched[station] == version:
                continue
            pod = consult.pod_for(robot, station)
            if pod >= 0:
                return self._send(robot, pod, station)
            self._searched[station] = version
        return None

    def _send(self, robot: Robot, pod: int, station: int) -> TaskDecision:
        """Let a robot bring a pod, or the robot beneath the pod if there is one."""
        chosen = keeper_of(self.view, robot, pod)
        if chosen is not robot:
            stations = self._station_of
            one, other = robot.index, chosen.index
            stations[one], stations[other] = stations[other], stations[one]
        return self.bring(chosen, pod, station)

    def bring(self, robot: Robot, pod: int, station: int) -> TaskDecision:
        """Count a robot as working for a station; return its task of bringing a pod there."""
        self.count(robot, station)
        return bring(self.view, robot, pod, station)

    def count(self, robot: Robot, station: int) -> None:
        """From now on, count a robot as working for a station (-1: for no station)."""
        former = self._works_for[robot.index]
        if former >= 0:
            self._workers[former] -= 1
        if station >= 0:
            self._workers[station] += 1
        self._works_for[robot.index] = station

    def _count_visitors(self) -> None:
        """Count robots bound for stations of other kinds, such as chargers, as without a station.

        These robots get their tasks from other controllers.
        """
        for station in self.view.all_stations[len(self.view.stations) :]:
            for task in station.tasks.values():
                if self._works_for[task.robot] >= 0:
                    self.count(self.view.robots[task.robot], -1)

    def workers(self, station: int, besides: Robot) -> int:
        """Return the number of robots that work for a station, without counting robot `besides`."""
        return self._workers[station] - (self._works_for[besides.index] == station)

    def _to_rest(self, robot: Robot) -> Rest:
        self.count(robot, -1)
        place = self.rest_place(robot)
        return Rest(robot, place if place >= 0 else robot.waypoint)

    def _wake(self, consult: Consult) -> Iterator[TaskDecision]:
        """Give work to robots at rest if their station has new work.

        Most stations have no new work. Examining the stations first, instead of each robot, is fast
        in large fleets.
        """
        resting = self.view.resting
        if not resting:
            return
        everybody = self.looks_elsewhere() or self.may_be_moved(consult)
        news = set() if everybody else self._stations_with_news()
        if not everybody and not news:
            return
        for robot in list(resting.values()):
            if not everybody and self._station_of[robot.index] not in news:
                continue
            if robot.index in resting:
                task = self._fetch(robot, consult) or self.instead_of_rest(robot, consult)
                if task is not None:
                    yield task
                    if not everybody:
                        news = self._stations_with_news()

    def _stations_with_news(self) -> set[int]:
        """Return the stations of robots at rest that have new work.

        Work is new if it has changed since no pod was found for it.
        """
        view, searched, with_work = self.view, self._searched, self._with_work
        for station in self._work_news.take():
            if view.has_open_work(station):
                with_work.add(station)
            else:
                with_work.discard(station)
        stations = with_work.intersection(map(self._station_of.__getitem__, view.resting))
        return {s for s in stations if searched[s] != view.work_version(s)}

    # --- who works for which station ------------------------------------------------------------

    def _balance(self, active: frozenset[int]) -> None:
        if active == self._active:
            return
        self._active = active
        targets = np.array([self.view.robot_target(robot) for robot in self.view.robots])
        distance = np.stack(
            [self.view.travel.metres(waypoint, targets) for waypoint in self._waypoints.tolist()],
            axis=1,
        )
        self._station_of = reassign(self._station_of, self.goals(active), distance)
