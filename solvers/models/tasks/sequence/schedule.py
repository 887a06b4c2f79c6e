r"""Arrival times of robots, and the cost and feasibility of their routes.

The cost, which is minimised, is

.. math::

    \sum driving + w \sum_{t \text{ done}} \max(0, arrive_t - due_t)
    + \sum_{t \text{ postponed}} skip_t

in seconds, where the first sum is over all drives, t is a task, and w is `late_weight`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.tasks.sequence.data import NONE, SLACK_S, Routes, TaskSequence


def approach_s(data: TaskSequence, robot: int, place: int, task: int) -> float:
    """Return the duration of the empty drive to the pod of a task, in s.

    Parameters
    ----------
    data
        The problem.
    robot
        Index of the robot.
    place
        Place where the robot stored its last pod, or `NONE` if it starts from its initial position.
    task
        Index of the task.
    """
    return float(data.reach_s[robot, task] if place == NONE else data.fetch_s[place, task])


def follow(
    data: TaskSequence, robot: int, tasks: tuple[int, ...], place: NDArray[np.int64], stowed: int
) -> tuple[float, list[float]]:
    """Compute the driving time and arrivals of one route.

    Parameters
    ----------
    data
        The problem.
    robot
        Index of the robot.
    tasks
        The robot's tasks in sequence.
    place
        Place where the pod of each task is stored, shape (T,).
    stowed
        Place where the robot stores the pod that it carries initially, or `NONE` if it carries
        none.

    Returns
    -------
    The driving time, in s, and for each task of the route the time when its pod arrives at its
    station, in s.
    """
    time_s, driving_s = float(data.ready_s[robot]), 0.0
    if stowed != NONE:
        driving_s = float(data.stow_s[robot, stowed])
        time_s += driving_s
    at, arrivals = stowed, []
    for task in tasks:
        inward_s = approach_s(data, robot, at, task) + float(data.bring_s[task])
        at = int(place[task])
        outward_s = float(data.store_s[task, at])
        arrivals.append(max(time_s + inward_s, float(data.earliest_s[task])))
        time_s = arrivals[-1] + float(data.service_s[task]) + outward_s
        driving_s += inward_s + outward_s
    return driving_s, arrivals


def lateness_s(data: TaskSequence, task: int, arrival_s: float) -> float:
    """Return the weighted lateness of a task, in s; infinite if its time window is missed.

    Parameters
    ----------
    data
        The problem.
    task
        Index of the task.
    arrival_s
        Time when the pod of the task arrives at its station, in s.
    """
    if arrival_s > data.latest_s[task] + SLACK_S:
        return math.inf
    return data.late_weight * max(0.0, arrival_s - float(data.due_s[task]))


def arrivals_s(data: TaskSequence, routes: Routes) -> NDArray[np.float64]:
    """Return the time when each task's pod arrives at its station, shape (T,), in s.

    The time is nan for postponed tasks.

    Parameters
    ----------
    data
        The problem.
    routes
        The routes.
    """
    arrive = np.full(data.tasks, np.nan)
    for robot, tasks in enumerate(routes.tasks):
        stowed = int(routes.robot_place[robot])
        arrive[list(tasks)] = follow(data, robot, tasks, routes.place, stowed)[1]
    return arrive


def objective(data: TaskSequence, routes: Routes) -> float:
    """Return the cost of driving, weighted lateness and postponed tasks, in s.

    Parameters
    ----------
    data
        The problem.
    routes
        The routes.
    """
    parts = [float(data.skip_s[task]) for task in np.flatnonzero(routes.place == NONE)]
    for robot, tasks in enumerate(routes.tasks):
        stowed = int(routes.robot_place[robot])
        driving_s, arrivals = follow(data, robot, tasks, routes.place, stowed)
        parts.append(driving_s)
        parts += [lateness_s(data, task, at) for task, at in zip(tasks, arrivals, strict=True)]
    return math.fsum(parts)


def violations(data: TaskSequence, routes: Routes) -> list[str]:
    """List the conditions that routes violate; empty if the routes are feasible.

    Parameters
    ----------
    data
        The problem.
    routes
        The routes.
    """
    done = [task for tasks in routes.tasks for task in tasks]
    stored = np.concatenate([routes.place, routes.robot_place])
    if len(routes.tasks) != data.robots or stored.shape != (data.tasks + data.robots,):
        return ["tasks and robot_place must have an entry per robot, and place one per task"]
    if not ((stored >= NONE) & (stored < data.places)).all():
        return ["a pod is stored at a location that does not exist"]
    found = []
    if sorted(done) != np.flatnonzero(routes.place != NONE).tolist():
        found.append("exactly the tasks with a location must be done, each by one robot")
    if ((routes.robot_place != NONE) != data.carrying).any():
        found.append("robot_place must be -1 if and only if the robot carries no pod")
    used = stored[stored != NONE]
    if len(np.unique(used)) < len(used):
        found.append("two pods are stored at one location")
    if not found and not math.isfinite(objective(data, routes)):
        found.append(
            "a drive is not allowed, a latest time is missed, or a task is left undone that must "
            "be done"
        )
    return found
