"""The times of a problem as whole numbers, and the route of one robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.tasks.sequence.data import NONE, TICKS_PER_S, Routes, TaskSequence

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

NEVER = 2**46
"""Value of a trip that is not allowed, and of a time that never comes, in ticks."""


class Route(NamedTuple):
    """A route of one robot.

    Attributes
    ----------
    robot
        Index of the robot.
    tasks
        Tasks of the robot, in sequence.
    places
        Places where pods are stored, in sequence: first the pod that the robot carries initially,
        if any, then the pods of the tasks.
    """

    robot: int
    tasks: tuple[int, ...]
    places: tuple[int, ...]

    @property
    def repeats(self) -> set[int]:
        """Places that the route uses more than once."""
        return {place for place in self.places if self.places.count(place) > 1}


class Ticks:
    """The times of a problem in whole ticks (milliseconds); `NEVER` replaces infinite times.

    The *owner* of a pod to be stored is the robot that carries it initially, or the task that
    brings it to a station. Robot r has the owner number r; task t has R + t, where R is the number
    of robots.

    Parameters
    ----------
    data
        The problem.
    """

    def __init__(self, data: TaskSequence) -> None:
        self.robots, self.tasks, self.places = data.robots, data.tasks, data.places
        self.carrying = data.carrying
        self.ready = _whole(data.ready_s)
        self.store = np.vstack([_whole(data.stow_s), _whole(data.store_s)])
        self.fetch = _whole(data.fetch_s)
        self.reach = _whole(data.reach_s)
        self.bring = _whole(data.bring_s)
        self.service = _whole(data.service_s)
        self.earliest = _whole(data.earliest_s)
        self.latest = _whole(data.latest_s)
        self.due = _whole(data.due_s)
        self.skip = _whole(data.skip_s)
        self.weight = data.late_weight

    def late(self, task: NDArray[np.int64], arrive: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the weighted lateness of arrivals, in ticks."""
        after: NDArray[np.int64] = self.weight * np.maximum(0, arrive - self.due[task])
        return after

    def cost(self, route: Route) -> int:
        """Return the driving time plus weighted lateness of a route, in ticks.

        All drives of the route must be allowed.
        """
        time, cost, at = int(self.ready[route.robot]), 0, NONE
        places = iter(route.places)
        if self.carrying[route.robot]:
            at = next(places)
            cost = int(self.store[route.robot, at])
            time += cost
        for task in route.tasks:
            way = int(self.reach[route.robot, task] if at == NONE else self.fetch[at, task])
            way += int(self.bring[task])
            time = max(time + way, int(self.earliest[task]))
            cost += way + self.weight * max(0, time - int(self.due[task]))
            at = next(places)
            way = int(self.store[self.robots + task, at])
            time += int(self.service[task]) + way
            cost += way
        return cost


def split(data: TaskSequence, routes: Routes) -> Iterator[Route]:
    """Yield the route of each robot."""
    for robot, tasks in enumerate(routes.tasks):
        places = [int(routes.place[task]) for task in tasks]
        first = [int(routes.robot_place[robot])] if data.carrying[robot] else []
        yield Route(robot, tuple(tasks), (*first, *places))


def joined(data: TaskSequence, driven: Iterable[Route]) -> Routes:
    """Combine routes of single robots into a plan; robots without a route do nothing."""
    tasks: list[tuple[int, ...]] = [()] * data.robots
    place, robot_place = np.full(data.tasks, NONE), np.full(data.robots, NONE)
    for route in driven:
        tasks[route.robot] = route.tasks
        places = route.places
        if data.carrying[route.robot]:
            robot_place[route.robot], places = places[0], places[1:]
        place[list(route.tasks)] = places
    return Routes(tuple(tasks), place, robot_place)


def _whole(time_s: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return times, which are whole ticks, as whole numbers; infinite ones as `NEVER`."""
    finite = np.isfinite(time_s)
    ticks = np.rint(np.where(finite, time_s, 0.0) * TICKS_PER_S).astype(np.int64)
    whole: NDArray[np.int64] = np.where(finite, ticks, NEVER)
    return whole
