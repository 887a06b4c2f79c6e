r"""The problem: free robots and waiting tasks.

.. math::

    \min \sum_{rt} travel_{rt}\, x_{rt} + \sum_t leave_t \Bigl(1 - \sum_r x_{rt}\Bigr), \quad
    \sum_r x_{rt} \le 1, \quad \sum_t x_{rt} \le 1

where :math:`x_{rt}` is 1 if robot r does task t. The cost :math:`leave_t` of leaving task t should
be the cost of waiting for another robot; if :math:`leave_t` is infinite, the task must be done.
Robots may stay idle. (In the literature, solving this problem without the option to leave tasks is
called dispatching by the Hungarian method.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs

LEFT = -1
"""Given instead of the index of a robot for a task that is left for later."""


@dataclass(frozen=True)
class Matching:
    """Free robots and waiting tasks.

    Parameters
    ----------
    travel_s
        Travel time of each robot to each task, shape (R, T), in s; +inf where the robot may not do
        the task.
    leave_s
        Cost of leaving each task for later, shape (T,), in s; +inf if it must be done.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    travel_s: NDArray[np.float64]
    leave_s: NDArray[np.float64]

    def __post_init__(self) -> None:
        travel_s = costs("travel_s", self.travel_s, (None, None), low=0)
        object.__setattr__(self, "travel_s", travel_s)
        object.__setattr__(self, "leave_s", costs("leave_s", self.leave_s, travel_s.shape[1:]))


def objective(data: Matching, robot: NDArray[np.int64]) -> float:
    """Return the travel time plus the cost of tasks left for later, in s.

    Parameters
    ----------
    data
        The problem.
    robot
        Robot of each task, or `LEFT` if the task is left for later, shape (T,).
    """
    done = robot != LEFT
    travel = data.travel_s[robot[done], np.flatnonzero(done)].sum()
    return float(travel + data.leave_s[~done].sum())


def violations(data: Matching, robot: NDArray[np.int64]) -> list[str]:
    """List the conditions that a choice of robots violates; empty if the choice is feasible.

    Parameters
    ----------
    data
        The problem.
    robot
        Robot of each task, or `LEFT` if the task is left for later, shape (T,).
    """
    robots, tasks = data.travel_s.shape
    if robot.shape != (tasks,) or not ((robot >= LEFT) & (robot < robots)).all():
        return ["robot must have a robot or -1 for each task"]
    done = robot != LEFT
    found = []
    if len(np.unique(robot[done])) < done.sum():
        found.append("a robot gets two tasks")
    if np.isinf(data.travel_s[robot[done], np.flatnonzero(done)]).any():
        found.append("a robot gets a task that it may not do")
    if np.isinf(data.leave_s[~done]).any():
        found.append("a task is left undone that must be done")
    return found
