"""Greedy matching: the pair that saves the most comes first."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule
from rmfs.solvers.models.tasks.matching.data import LEFT, Matching, objective, violations


def solve(
    data: Matching,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Repeatedly match the robot and the task that save the most compared with leaving the task.

    Before that, tasks that must be done are matched, the pair with the shortest travel time first.
    The bound is computed as if a robot could do any number of tasks.

    Returns
    -------
    The robot of each task, or `LEFT` if the task is left for later, shape (T,); ties go to the
    robot with the lowest index, then to the task with the lowest index. The status is INFEASIBLE if
    some task must be done and no robot may do it, and LIMIT if a task that must be done is left for
    another reason.
    """
    begin = perf_counter()
    robots, tasks = data.travel_s.shape
    robot = np.full(tasks, LEFT, np.int64)
    idle = np.ones(robots, bool)
    must = np.isinf(data.leave_s)
    gain = np.where(must, 0.0, data.leave_s) - data.travel_s
    for group in (must, ~must):
        order = np.argsort(-np.where(group, gain, -math.inf), axis=None, kind="stable")
        for one, task in zip(*np.unravel_index(order, gain.shape), strict=True):
            if not group[task] or gain[one, task] == -math.inf:
                break
            if idle[one] and robot[task] == LEFT and (must[task] or gain[one, task] > 0):
                robot[task] = one
                idle[one] = False
    best = np.minimum(data.travel_s.min(axis=0, initial=math.inf), data.leave_s)
    bound, work = float(best.sum()), float(gain.size)
    return solution_of_rule(
        None if violations(data, robot) else robot,
        lambda values: objective(data, values),
        bound=bound,
        work=work,
        began=begin,
    )
