"""TA routes: combines storing one pod with fetching the next, for all robots together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
import pydantic

from rmfs.control.asks import Answer, Ask
from rmfs.control.decisions import Park
from rmfs.control.problems import Problem
from rmfs.control.psa.nearest import Nearest
from rmfs.control.ta.stations import bring, keeper_of
from rmfs.solvers.control.answers import answer
from rmfs.solvers.control.parameters import SearchParameters
from rmfs.solvers.control.tasks.asking import Asking, NotNegative, TaskParameters
from rmfs.solvers.control.tasks.jobs import Job, Worth, jobs
from rmfs.solvers.models.solution import Limits
from rmfs.solvers.models.tasks import sequence
from rmfs.solvers.models.tasks.sequence import TaskSequence
from rmfs.world.tasks import ParkTask, PickTask, ReplenishTask

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from rmfs.control.asks import Call
    from rmfs.control.decisions import Prepare, TaskDecision
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

Count = Annotated[int, pydantic.Field(ge=1)]
NONE = -1


@dataclass(frozen=True)
class Question:
    """A routing problem of robots, pods and empty storage locations (places), and how to solve it.

    Attributes
    ----------
    method
        `lns`, `cp_sat`, `columns` or `greedy`.
    tasks, places
        For CP-SAT: number of tasks considered as the next task after the storing of each pod, and
        number of places considered for each such pair of pod and next task.
    """

    data: TaskSequence
    method: str
    limits: Limits
    tasks: int
    places: int


def solve(question: Question) -> Answer:
    """Plan routes; the answer has their first steps.

    For each robot, `place` is the index of the place where it stores the pod that it carries, and
    `task` is the index of the first task of its route; both have the shape (R,), with -1 for none.
    CP-SAT and column generation start from the solution of cheapest insertion. CP-SAT considers
    only the trips of this solution and other short trips (see `Question`).
    """
    data = question.data
    found = sequence.solve(data, "lns" if question.method == "lns" else "greedy", question.limits)
    if found.values is not None and question.method == "columns" and data.tasks:
        found = sequence.solve(data, "columns", question.limits, start=found.values)
    elif found.values is not None and question.method == "cp_sat" and data.tasks:
        ways = sequence.short_ways(data, found.values, tasks=question.tasks, places=question.places)
        found = sequence.solve(data, "cp_sat", question.limits, start=found.values, ways=ways)
    if found.values is None:
        return answer(found, None)
    routes = found.values
    first = np.array([tasks[0] if tasks else NONE for tasks in routes.tasks], np.int64)
    return answer(found, {"place": routes.robot_place, "task": first})


@dataclass(frozen=True)
class Memo:
    """The objects behind the indices of a question.

    Attributes
    ----------
    robots
        The robots of the routes.
    again
        Robots at a station that has more work for their pod.
    jobs
        The job behind each task.
    places
        Waypoint of each place, shape (L,).
    """

    robots: list[Robot]
    again: list[Robot]
    jobs: list[Job]
    places: NDArray[np.int32]


class RoutesParameters(TaskParameters, SearchParameters):
    """Parameters of TA routes."""

    method: Literal["lns", "cp_sat", "columns", "greedy"] = "lns"
    """Solution method: `lns` (large neighbourhood search), `greedy` (cheapest insertion), or
    `cp_sat` (CP-SAT) or `columns` (column generation), which start from the solution of
    `greedy`."""
    steps: Annotated[int, pydantic.Field(ge=0)] = sequence.STEPS_PER_TASK
    """Number of search steps of `lns` per task in the problem."""
    work_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.01
    """Limit of the search by `cp_sat` or `columns` in deterministic seconds, which are close to
    wall time. At large sites, `columns` needs about 0.6."""
    gap: NotNegative = 0.01
    """Relative gap between objective value and bound at which `cp_sat` or `columns` ends."""
    unit_value_s: NotNegative = 100.0
    """Value of picking a unit, in seconds of robot time."""
    order_value_s: NotNegative = 100.0
    """Value of completing an order, in seconds of robot time."""
    bundle_value_s: NotNegative = 150.0
    """Value of storing a bundle, in seconds of robot time."""
    late_weight: Annotated[int, pydantic.Field(ge=0)] = 3
    """Cost, in seconds of driving, of each second by which a pod arrives after its station has
    finished the previous pods."""
    pods_per_station: Count = 2
    """Maximum number of next pods considered for each station."""
    places_per_robot: Count = 6
    """Number of empty storage locations considered for each carried pod: those nearest to the
    robot."""
    places_per_task: Count = 3
    """For each pod to be fetched, number of nearby empty storage locations at which robots may
    store other pods first."""
    ways_per_pod: Count = 2
    """Number of tasks that `cp_sat` considers as the next task after each pod has been stored."""


class RoutesControl(Asking[RoutesParameters]):
    """Plans routes in which robots store and fetch pods, and lets each robot take the first step.

    Routes are planned for the robots that need a task, are at rest, are storing a pod, or have a
    pod in service at a station. A task is to bring a pod to a station; for every station, there are
    tasks for the pods that it could best use next. The pod of a task is due when the station has
    finished the previous pods. The objective combines driving, lateness and the value of tasks left
    undone. A pod is therefore stored at a storage location (place) for which the whole trip, to the
    place and on to the next pod, is short; this need not be the nearest place. A new plan is made
    when a robot needs a task, or when there is new work for robots at rest.

    A pod stays at its station while the station has work for it. The routes determine pods and
    places, so PPS and PSA must be `dummy`. A robot with a pod but without a valid decision takes
    the pod to a station that the pod can serve or, if there is none, to the nearest empty place.
    """

    parameters_model = RoutesParameters
    decides: ClassVar[frozenset[Problem]] = frozenset({Problem.PPS, Problem.PSA})
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.solvers.control.tasks.routes",)

    def __init__(self, parameters: RoutesParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._nearest = Nearest(Nearest.parameters_model(), view, rng)
        self._transfer_s = max(kind.pod_transfer_s for kind in view.layout.robot_kinds)
        given = parameters
        self._worth = Worth(given.unit_value_s, given.order_value_s, given.bundle_value_s)

    def place(self, robot: Robot) -> int:
        """Return the nearest empty place; -1 if there is none."""
        return self._nearest.place(robot)

    def place_for(self, robot: Robot, consult: Consult) -> int:
        """Return the nearest empty place; -1 if there is none."""
        return self.place(robot)

    def pod_for(self, robot: Robot, station: int, consult: Consult) -> int:
        """Return the best next pod of a station, or -1 if there is none."""
        return next((job.pod for job in self._jobs() if job.station == station), NONE)

    def question(self, robots: Sequence[Robot], consult: Consult) -> Ask[Question]:
        """Return the routing problem."""
        given, view = self.parameters, self.view
        again = [
            r for r in robots if r.pod >= 0 and r.station >= 0 and consult.serves(r.pod, r.station)
        ]
        planned = [robot for robot in robots if robot not in again]
        planned += [robot for robot in view.robots if _is_soon_free(robot)]
        found = self._jobs()
        places = self._places(planned, found)
        data = self._routing(planned, found, places)
        limits = given.limits
        if given.method == "lns":
            limits = Limits(iterations=given.steps * data.tasks)
        question = Question(data, given.method, limits, given.ways_per_pod, 2)
        sizes = {"robots": len(planned), "tasks": len(found), "places": len(places)}
        return Ask(solve, question, sizes, Memo(planned, again, found, places))

    def carry_out(self, call: Call, consult: Consult) -> Iterator[TaskDecision | Prepare]:
        """Let the robots that need a task or are at rest take the first steps of their routes."""
        assert call.solution is not None
        memo: Memo = call.ask.memo
        view = self.view
        for robot in call.left("again", memo.again):
            if robot.task is None and consult.serves(robot.pod, robot.station):
                yield bring(view, robot, robot.pod, robot.station)
            else:
                call.stale += 1
        steps = zip(memo.robots, call.solution["place"], call.solution["task"], strict=True)
        for robot, place, task in call.left("steps", list(steps)):
            if robot.task is not None and robot.index not in view.resting:
                continue
            if robot.pod >= 0:
                if place >= 0 and self._is_empty(memo.places[place]):
                    yield Park(robot, int(memo.places[place]))
                else:
                    call.stale += 1
            elif task >= 0:
                job = memo.jobs[int(task)]
                if view.storage.is_at_hand[job.pod] and consult.serves(job.pod, job.station):
                    yield bring(view, keeper_of(view, robot, job.pod), job.pod, job.station)
                else:
                    call.stale += 1
            elif robot.task is None:
                yield self.to_rest(robot)

    def _jobs(self) -> list[Job]:
        given = self.parameters
        return jobs(self.view, self._worth, given.robots_per_station, given.pods_per_station)

    def _is_empty(self, place: int) -> bool:
        storage = self.view.storage
        return bool(storage.is_empty[storage.place_index[place]])

    def _places(self, robots: Sequence[Robot], tasks: Sequence[Job]) -> NDArray[np.int32]:
        """Choose empty places near the stations of pods to store, and near pods to fetch."""
        given, storage, travel = self.parameters, self.view.storage, self.view.travel
        empty = storage.places[storage.is_empty]
        if not len(empty):
            return empty
        kept = []
        for robot in robots:
            if robot.pod >= 0:
                away_s = travel.away(robot.waypoint, loaded=True)[empty]
                kept.append(np.argsort(away_s, kind="stable")[: given.places_per_robot])
        for job in tasks:
            away_s = travel.estimate_s(storage.place_of[job.pod], empty)
            kept.append(np.argsort(away_s, kind="stable")[: given.places_per_task])
        chosen: NDArray[np.int32] = empty[np.unique(np.concatenate(kept))] if kept else empty[:0]
        return chosen

    def _routing(
        self, robots: Sequence[Robot], tasks: Sequence[Job], places: NDArray[np.int32]
    ) -> TaskSequence:
        view, travel = self.view, self.view.travel
        at = np.array([view.storage.place_of[job.pod] for job in tasks], np.int32)
        of = [view.stations[job.station].waypoint for job in tasks]
        shape = len(tasks), len(places)

        def away_s(waypoints: Sequence[int]) -> NDArray[np.float64]:
            rows = [travel.away(waypoint, loaded=True)[places] for waypoint in waypoints]
            return np.array(rows).reshape(len(waypoints), len(places)) + self._transfer_s

        carrying = np.array([robot.pod >= 0 and not _is_parking(robot) for robot in robots], bool)
        stow_s = np.zeros((len(robots), len(places)))
        carriers = np.flatnonzero(carrying)
        stow_s[carriers] = away_s([robots[row].waypoint for row in carriers.tolist()])
        return TaskSequence(
            ready_s=np.array([self._ready_s(robot) for robot in robots]),
            carrying=carrying,
            reach_s=np.array([travel.estimate_s(robot.waypoint, at) for robot in robots]).reshape(
                len(robots), len(tasks)
            ),
            stow_s=stow_s,
            fetch_s=np.array([travel.estimate_s(place, at) for place in places.tolist()]).reshape(
                shape[::-1]
            ),
            bring_s=np.array([job.bring_s + self._transfer_s for job in tasks]),
            service_s=np.array([job.service_s for job in tasks]),
            store_s=away_s(of),
            earliest_s=np.zeros(len(tasks)),
            latest_s=np.full(len(tasks), np.inf),
            due_s=np.array([job.due_s for job in tasks]),
            skip_s=np.array([job.worth_s for job in tasks]),
            late_weight=self.parameters.late_weight,
        )

    def _ready_s(self, robot: Robot) -> float:
        """Return the time from now until a robot can start its route, in s."""
        view = self.view
        if _is_parking(robot):
            at = view.travel.robot_waypoint(robot.index)
            way_s = view.travel.estimate_s(at, np.array([robot.waypoint], np.int32))
            return float(way_s[0]) + self._transfer_s
        task = robot.task
        if robot.station < 0 or task is None:
            return 0.0
        if isinstance(task, PickTask):
            seconds = view.unit_s(robot.station)
            return seconds * len(task.picks)
        if isinstance(task, ReplenishTask):
            number = view.stations[robot.station].number
            each_s = view.layout.replenishment_stations[number].bundle_transfer_s
            return each_s * len(task.bundles)
        return 0.0


def _is_parking(robot: Robot) -> bool:
    return isinstance(robot.task, ParkTask)


def _is_soon_free(robot: Robot) -> bool:
    """Whether a robot has a task that will end soon: storing a pod, or being served."""
    return robot.task is not None and (_is_parking(robot) or robot.station >= 0)
