r"""Assignment of robots to tasks with balanced queues, as a minimum-cost flow.

Each robot sends one unit, either through a task and the station of the task to the sink or, if the
robot stays idle, directly to the sink. From station s to the sink there are arcs of capacity 1 with
costs :math:`(queue_s + k - 1) service_s`, :math:`k = 1, 2, \dots`. As the costs increase with k,
the first arcs are used first, and their costs add up to the waiting time. The cost of leaving a
task is charged in advance and refunded on the arc from the task to its station. A task that must be
done has a demand of one unit instead of an arc to its station, and the station supplies one unit.
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.flow import Network, min_cost_flow
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_optimum
from rmfs.solvers.models.tasks.balance.data import Balance, objective
from rmfs.solvers.models.tasks.matching.data import LEFT


def solve(
    data: Balance,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Find the optimal robot of each task.

    Returns
    -------
    The robot of each task, or `LEFT` if the task is left for later, shape (T,). Work is the number
    of arcs of the network.
    """
    begin = perf_counter()
    pair_s = data.pairs.travel_s
    pair_robot, pair_task = np.nonzero(np.isfinite(pair_s))
    network = _network(data, pair_s, pair_robot, pair_task)
    built = perf_counter()
    flow = min_cost_flow(network)
    robot = None
    if flow is not None:
        robot = np.full(len(data.leave_s), LEFT, np.int64)
        used = flow.units[: len(pair_task)] > 0
        robot[pair_task[used]] = pair_robot[used]
    paid = math.fsum(data.leave_s[np.isfinite(data.leave_s)])
    return solution_of_optimum(
        robot,
        lambda values: objective(data, values),
        bound=math.inf if flow is None else paid + flow.bound,
        backend="min_cost_flow",
        work=0.0 if flow is None else flow.work,
        began=begin,
        built=built,
    )


def _network(
    data: Balance,
    pair_s: NDArray[np.float64],
    pair_robot: NDArray[np.int64],
    pair_task: NDArray[np.int64],
) -> Network:
    """Lay out robots, tasks, stations and the sink; the first arcs are the pairs."""
    robots, tasks = pair_s.shape
    stations = len(data.room)
    of_task, of_station = robots + np.arange(tasks), robots + tasks + np.arange(stations)
    sink = robots + tasks + stations
    must = np.isinf(data.leave_s)
    may = np.flatnonzero(~must)
    supply = np.zeros(sink + 1, np.int64)
    supply[:robots] = 1
    supply[of_task[must]] = -1
    np.add.at(supply, of_station[data.station[must]], 1)
    supply[sink] = -robots

    most = np.minimum(data.room, np.bincount(data.station, minlength=stations))
    last = np.repeat(np.arange(stations), most)
    rank = np.arange(len(last)) - np.repeat(np.cumsum(most) - most, most)
    arcs = (
        (pair_robot, of_task[pair_task], pair_s[pair_robot, pair_task]),
        (np.arange(robots), np.full(robots, sink), np.zeros(robots)),
        (of_task[may], of_station[data.station[may]], -data.leave_s[may]),
        (
            of_station[last],
            np.full(len(last), sink),
            (data.queue[last] + rank) * data.service_s[last],
        ),
    )
    tail, head, cost = (np.concatenate(part) for part in zip(*arcs, strict=True))
    return Network(tail, head, np.ones(len(tail), np.int64), cost, supply)
