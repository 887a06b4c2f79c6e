"""Initial plans for a search, found by assignment: no tasks, or at most one task per robot."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.assignment import assign
from rmfs.solvers.models.tasks.sequence.bound import from_robots
from rmfs.solvers.models.tasks.sequence.data import NONE, SLACK_S, Routes, TaskSequence


def without_tasks(data: TaskSequence) -> Routes | None:
    """Return the routes that only store the pods that robots carry, with the least driving.

    Parameters
    ----------
    data
        The problem.

    Returns
    -------
    The routes; None if the pods cannot all be stored at different places.
    """
    return _stored(data, ((),) * data.robots)


def first_tasks(data: TaskSequence) -> Routes | None:
    """Give each robot at most one task, at the least cost of driving, lateness and postponement.

    First, the tasks are assigned as if any number of pods could share a place. Then different
    places are assigned to the pods, at the least driving time.

    Parameters
    ----------
    data
        The problem.

    Returns
    -------
    The routes, which may violate time windows and may postpone tasks that must be done; None if the
    pods cannot all be stored at different places.
    """
    ready_s, way_s, _ = from_robots(data)
    arrive_s = np.maximum(ready_s + data.bring_s, data.earliest_s)
    storing_s = data.store_s.min(axis=1, initial=math.inf)
    late_s = np.maximum(0.0, np.where(np.isfinite(arrive_s), arrive_s, 0.0) - data.due_s)
    cost = way_s + data.bring_s + storing_s + data.late_weight * late_s
    cost[arrive_s > data.latest_s + SLACK_S] = math.inf
    leaving = np.full((data.tasks, data.tasks), math.inf)
    finite = cost[np.isfinite(cost)]
    # a task that must be done may follow later, but not if it can come first
    most = 1.0 + float(np.abs(finite).sum())
    np.fill_diagonal(leaving, np.where(np.isfinite(data.skip_s), data.skip_s, most))
    assigned = assign(np.hstack([cost.T, leaving]))
    if assigned is None:
        return None
    tasks: list[tuple[int, ...]] = [()] * data.robots
    for task, robot in enumerate(assigned.column.tolist()):
        if robot < data.robots:
            tasks[robot] = (task,)
    return _stored(data, tuple(tasks))


def _stored(data: TaskSequence, tasks: tuple[tuple[int, ...], ...]) -> Routes | None:
    """Choose a place for every pod, at the least total driving; None if that is impossible."""
    carriers = np.flatnonzero(data.carrying).tolist()
    way_s = [
        data.stow_s[robot] + (data.fetch_s[:, tasks[robot][0]] if tasks[robot] else 0.0)
        for robot in carriers
    ]
    done = [task for one in tasks for task in one]
    way_s += [data.store_s[task] for task in done]
    assigned = assign(np.array(way_s).reshape(len(way_s), data.places))
    if assigned is None:
        return None
    place = np.full(data.tasks, NONE, np.int64)
    robot_place: NDArray[np.int64] = np.full(data.robots, NONE, np.int64)
    robot_place[carriers] = assigned.column[: len(carriers)]
    place[done] = assigned.column[len(carriers) :]
    return Routes(tasks, place, robot_place)
