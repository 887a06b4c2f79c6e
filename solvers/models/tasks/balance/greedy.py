"""Assign tasks in turn, most urgent first, each to the robot that arrives first."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule
from rmfs.solvers.models.tasks.balance.data import Balance, objective, violations
from rmfs.solvers.models.tasks.matching.data import LEFT


def solve(
    data: Balance,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Let tasks choose robots in order of due time; tasks that must be done come first.

    A task is left for later if none of the remaining robots may do it, if its station has no room
    left, or if leaving it costs no more than its travel, lateness and additional waiting. The bound
    is computed as if a robot could do any number of tasks, and as if the robots sent to a station
    did not wait for each other.

    Returns
    -------
    The robot of each task, or `LEFT` if the task is left for later, shape (T,); ties go to the
    lowest index. The status is INFEASIBLE if some task must be done and no robot may do it, and
    LIMIT if a task that must be done is left for another reason.
    """
    begin = perf_counter()
    pair_s = data.pairs.travel_s.copy()
    waiting_s = data.queue * data.service_s
    cheapest = pair_s.min(axis=0, initial=math.inf) + waiting_s[data.station]
    bound = float(np.minimum(cheapest, data.leave_s).sum())
    robot = np.full(len(data.leave_s), LEFT, np.int64)
    sent = np.zeros(len(data.room), np.int64)
    for task in np.lexsort((data.due_s, np.isfinite(data.leave_s))).tolist():
        station = int(data.station[task])
        if sent[station] >= data.room[station] or not len(pair_s):
            continue
        best = int(pair_s[:, task].argmin())
        added = waiting_s[station] + sent[station] * data.service_s[station]
        cost = pair_s[best, task] + added
        if math.isfinite(cost) and cost < data.leave_s[task]:
            robot[task] = best
            sent[station] += 1
            pair_s[best] = math.inf
    return solution_of_rule(
        None if violations(data, robot) else robot,
        lambda values: objective(data, values),
        bound=bound,
        work=float(pair_s.size),
        began=begin,
    )
