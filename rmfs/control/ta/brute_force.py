"""TA brute-force: chooses the pair of pod and station for which service can begin soonest."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Annotated, ClassVar, NamedTuple

import numpy as np
import pydantic

from rmfs.control.congestion import CongestionParameters
from rmfs.control.decisions import Park, Prepare, TaskDecision
from rmfs.control.problems import Problem
from rmfs.control.ta.solo import Solo, SoloParameters
from rmfs.control.ta.stations import bring, keeper_of
from rmfs.world.tasks import ParkTask

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class BruteForceParameters(CongestionParameters, SoloParameters):
    """Parameters of TA brute-force."""

    queue_cost_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 1.0
    """Factor of the expected wait at a station: the wait in seconds is this factor times the square
    of the number of robots at the station or on their way there."""


class _Job(NamedTuple):
    """A pair of pod and station, and the estimated time until service begins, in s."""

    seconds: float
    station: int
    pod: int


class BruteForce(Solo[BruteForceParameters]):
    """Chooses the pair of pod and station for which service can begin soonest.

    For each robot, the rule compares all pairs of a pod and a station with work for this pod. The
    pods are the available ones and the one that the robot carries, if any. The pair with the least
    estimated time until service is chosen. The estimate is the sum of three terms: the time of a
    straight trip from robot to pod at top speed; the time to lift the pod (and, if the robot
    carries another pod, to set down that pod); and either the time of the unhindered trip to the
    station or the expected wait there, whichever is longer. For the carried pod, only the last term
    counts. The delay that congestion is expected to cause, times the weight `congestion`, is added
    to the time of each trip. Ties go to the carried pod, then to the station with the lowest
    number, then to the pod with the lowest number.

    The rule considers only one kind of work at a time, picks or bundles, and begins with picks. If
    there is no work of this kind for a robot but there is work of the other kind, the rule changes
    to the other kind for all robots.

    If the best pod is not the carried one, the robot first parks the carried pod, then fetches the
    best one. The carried pod is parked at the empty storage location for which the time to drive
    there, plus the time of a straight trip from there to the best pod, is least. If another robot
    has taken the best pod meanwhile, the robot searches again. If there is no work, the carried pod
    is parked at the nearest empty location. The rule chooses pods and storage locations itself, so
    PPS and PSA must be `dummy`; bundles go into the pods chosen by RPS.
    """

    parameters_model = BruteForceParameters
    decides: ClassVar[frozenset[Problem]] = frozenset({Problem.PPS, Problem.PSA})

    def __init__(
        self, parameters: BruteForceParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        parameters.prepare(view)
        self._picks = True
        self._parked: tuple[float, Park, Prepare] | None = None

    def decide(self, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Yield a task for every robot that needs one, and work for robots at rest.

        If the run is copied just after the rule has yielded the parking of a pod, the copy asks the
        rule anew; the first task is then the one that follows the parking.
        """
        if self._parked is not None:
            at_s, (robot, place), prepare = self._parked
            self._parked = None
            is_parking = isinstance(robot.task, ParkTask) and robot.task.place == place
            if is_parking and at_s == self.view.now_s:
                yield prepare
        yield from super().decide(consult)

    def task_for(self, robot: Robot, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Yield the best task or, if there is no work, the task of parking or resting.

        If the robot carries a pod other than the best one, yield the task of parking the carried
        pod, then a `Prepare` with the best task.
        """
        view = self.view
        job = self._best(robot, consult)
        if job is None:
            if robot.pod < 0:
                yield self.to_rest(robot)
            else:
                yield from self._park(robot)
        elif robot.pod in (-1, job.pod):
            yield self._bring(robot, job)
        else:
            speed = view.layout.robot_kinds[view.layout.robot_kind[robot.index]].top_speed_m_s
            place = view.storage.place_of[job.pod]
            on = view.travel.metres(place, view.storage.places) / speed
            for park in self._park(robot, on):
                prepare = Prepare(robot, (bring(view, robot, job.pod, job.station),))
                self._parked = view.now_s, park, prepare
                yield park
                self._parked = None
                yield prepare

    def work_for(self, robot: Robot, consult: Consult) -> TaskDecision | None:
        """Find the best task for a robot without a pod; None if there is no work."""
        job = self._best(robot, consult)
        return None if job is None else self._bring(robot, job)

    def _bring(self, robot: Robot, job: _Job) -> TaskDecision:
        if job.pod != robot.pod:
            robot = keeper_of(self.view, robot, job.pod)
        return bring(self.view, robot, job.pod, job.station)

    def place(self, robot: Robot, on_s: NDArray[np.float64] | float = 0.0) -> int:
        """Find the empty place for which the time to drive there plus `on_s` is least.

        Parameters
        ----------
        on_s
            Time from each place to the next destination, in s, shape (L,).

        Returns
        -------
        int
            The place (waypoint), or -1 if there is none.
        """
        storage = self.view.storage
        there = self.view.travel.away(robot.waypoint, loaded=True)[storage.places]
        total = np.where(storage.is_empty, there + on_s, inf)
        best = int(total.argmin())
        return int(storage.places[best]) if total[best] < inf else -1

    def _park(self, robot: Robot, on_s: NDArray[np.float64] | float = 0.0) -> Iterator[Park]:
        """Park at the best place, if there is one; see `place`."""
        place = self.place(robot, on_s)
        if place >= 0:
            yield Park(robot, place)

    def _best(self, robot: Robot, consult: Consult) -> _Job | None:
        """Find the best job of the present kind or, if there is none, of the other."""
        to_pods = self._to_pods(robot)
        for picks in (self._picks, not self._picks):
            jobs = list(self._jobs(robot, picks, to_pods, consult))
            if jobs:
                self._picks = picks
                return min(jobs, key=lambda job: (job.seconds, job.pod != robot.pod))
        return None

    def _to_pods(self, robot: Robot) -> NDArray[np.float64]:
        """Estimate the time in s until the robot has lifted each stored pod, shape (P,)."""
        view = self.view
        kind = view.layout.robot_kinds[view.layout.robot_kind[robot.index]]
        where = view.travel.robot_waypoint(robot.index)
        transfers = kind.pod_transfer_s * (1 if robot.pod < 0 else 2)
        seconds = view.travel.metres(where, view.storage.pod_waypoint)
        seconds /= kind.top_speed_m_s
        seconds += transfers
        seconds += self.parameters.delay_s(view, where, view.storage.pod_waypoint)
        return seconds

    def _jobs(
        self, robot: Robot, picks: bool, to_pods: NDArray[np.float64], consult: Consult
    ) -> Iterator[_Job]:
        """Yield the best job of each station, by station."""
        view = self.view
        here = np.array([robot.waypoint])
        for station in view.pick_stations if picks else view.replenishment_stations:
            index, waypoint = station.index, station.waypoint
            if not view.has_open_work(index):
                continue
            to_station = view.travel.to(waypoint, loaded=True)
            wait_s = self.parameters.queue_cost_s * len(station.tasks) ** 2
            if robot.pod >= 0 and consult.serves(robot.pod, index):
                bring_s = to_station[here] + self.parameters.delay_s(view, waypoint, here)
                yield _Job(max(bring_s.item(), wait_s), index, robot.pod)
            pods = self.pods_for(robot, index)
            if len(pods):
                at = view.storage.pod_waypoint[pods]
                bring_s = to_station[at] + self.parameters.delay_s(view, waypoint, at)
                on_s = np.maximum(bring_s, wait_s)
                seconds = to_pods[pods] + on_s
                best = int(seconds.argmin())
                yield _Job(float(seconds[best]), index, int(pods[best]))
