"""The problem: robots, tasks and free places, with the times between them.

A *task* consists of fetching a pod, bringing it to a station, waiting there while it is served, and
storing it at a free storage location (*place*). A robot does tasks one after another; a robot that
initially carries a pod stores this pod first. The distance to the next pod depends on where the
previous pod is stored, so places are chosen together with the sequence of tasks. This is a
generalised travelling-salesman problem as in Gharehgozli and Zaerpour 2020, with several robots and
time windows.

Places from which pods are fetched do not become free within the same plan; with a rolling horizon,
a new plan is made before these places are needed. Queues at stations are represented only by the
time windows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs, flags, integers, reals, require

NONE = -1
"""Stands for no place, for a pod that is not moved."""

TICKS_PER_S = 1000
"""Input times are rounded to milliseconds, so that all back ends solve the same problem."""

LONGEST_S = 1e9
"""Longest finite time, so that sums of milliseconds fit into the integers of all back ends."""

SLACK_S = 1e-7
"""Tolerance for rounding errors in sums of whole milliseconds."""


@dataclass(frozen=True)
class TaskSequence:
    """Robots, tasks and free places.

    Times are rounded to milliseconds, and finite times are at most `LONGEST_S`. Times of drives may
    be +inf (the drive is then not allowed), and so may `latest_s`, `due_s` and `skip_s`.

    Parameters
    ----------
    ready_s
        Time when each robot can begin, shape (R,), in s.
    carrying
        Whether each robot carries a pod, shape (R,).
    reach_s
        Empty drive of each robot to the pod of each task, shape (R, T), in s; not read for robots
        that carry a pod.
    stow_s
        Drive of each robot with its pod to each place, set-down included, shape (R, L), in s; not
        read for robots that carry none.
    fetch_s
        Empty drive from each place to the pod of each task, shape (L, T), in s.
    bring_s
        Time to lift the pod of each task and bring it to its station, shape (T,), in s.
    service_s
        Time that the pod of each task spends at its station, shape (T,), in s.
    store_s
        Drive from the station of each task to each place, set-down included, shape (T, L), in s.
    earliest_s, latest_s
        Time window for the arrival of each task's pod at its station, shape (T,), in s. A robot
        that is early waits; a task whose pod would be too late cannot be done. A latest time of
        +inf means no limit.
    due_s
        Time when the pod of each task should be at its station, shape (T,), in s; +inf without a
        due time.
    skip_s
        Cost of postponing each task, shape (T,), in s; +inf if it must be done.
    late_weight
        Cost of one second of lateness, in seconds of driving; an integer. Default 1.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    ready_s: NDArray[np.float64]
    carrying: NDArray[np.bool_]
    reach_s: NDArray[np.float64]
    stow_s: NDArray[np.float64]
    fetch_s: NDArray[np.float64]
    bring_s: NDArray[np.float64]
    service_s: NDArray[np.float64]
    store_s: NDArray[np.float64]
    earliest_s: NDArray[np.float64]
    latest_s: NDArray[np.float64]
    due_s: NDArray[np.float64]
    skip_s: NDArray[np.float64]
    late_weight: int = 1

    def __post_init__(self) -> None:
        ready_s = reals("ready_s", self.ready_s, (None,), low=0)
        bring_s = reals("bring_s", self.bring_s, (None,), low=0)
        fetch_s = costs("fetch_s", self.fetch_s, (None, len(bring_s)), low=0)
        robots, tasks, places = len(ready_s), len(bring_s), len(fetch_s)
        checked = {
            "ready_s": ready_s,
            "reach_s": costs("reach_s", self.reach_s, (robots, tasks), low=0),
            "stow_s": costs("stow_s", self.stow_s, (robots, places), low=0),
            "fetch_s": fetch_s,
            "bring_s": bring_s,
            "service_s": reals("service_s", self.service_s, (tasks,), low=0),
            "store_s": costs("store_s", self.store_s, (tasks, places), low=0),
            "earliest_s": reals("earliest_s", self.earliest_s, (tasks,), low=0),
            "latest_s": costs("latest_s", self.latest_s, (tasks,), low=0),
            "due_s": costs("due_s", self.due_s, (tasks,)),
            "skip_s": costs("skip_s", self.skip_s, (tasks,), low=0),
        }
        for field, value in checked.items():
            huge = np.isfinite(value) & (np.abs(value) > LONGEST_S)
            require(not huge.any(), field, f"must be at most {LONGEST_S:g} s, or infinite")
            exact = np.rint(value * TICKS_PER_S) / TICKS_PER_S
            exact.setflags(write=False)
            object.__setattr__(self, field, exact)
        object.__setattr__(self, "carrying", flags("carrying", self.carrying, (robots,)))
        weight = int(integers("late_weight", self.late_weight, (), low=0))
        object.__setattr__(self, "late_weight", weight)

    @property
    def robots(self) -> int:
        """Number of robots."""
        return len(self.ready_s)

    @property
    def tasks(self) -> int:
        """Number of tasks."""
        return len(self.bring_s)

    @property
    def places(self) -> int:
        """Number of free places."""
        return len(self.fetch_s)


@dataclass(frozen=True)
class Routes:
    """The tasks of each robot, and the places where pods are stored.

    Attributes
    ----------
    tasks
        The tasks of each robot in sequence, one tuple per robot.
    place
        Place where the pod of each task is stored, or `NONE` if the task is postponed, shape (T,).
    robot_place
        Place where each robot stores the pod that it carries initially, or `NONE` if it carries
        none, shape (R,).
    """

    tasks: tuple[tuple[int, ...], ...]
    place: NDArray[np.int64]
    robot_place: NDArray[np.int64]
