r"""A lower bound: routes are relaxed to pairs of a task and its predecessor.

The relaxation ignores that each place is used at most once and that each chain of tasks must begin
at a robot. It uses the earliest possible arrival of each task instead of the actual one. What
remains is an assignment problem: each task t directly follows a robot r or another task o, or is
postponed. Let :math:`s_o = \min_l store_{ol}` be the time to store the pod of o at the nearest
place. If t follows o, the cost of t is

.. math::

    \min_l (store_{ol} + fetch_{lt}) - s_o + bring_t + s_t + w \max(0, e_t - due_t)

where w is the weight of lateness and :math:`e_t` is the earliest arrival at the station of t over
all chains; the other symbols are those of `TaskSequence`. The first two terms are the time that the
drive to the pod of t adds to :math:`s_o`, which is part of the cost of o.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.assignment import assign
from rmfs.solvers.models.tasks.sequence.candidates import shortest_over_places
from rmfs.solvers.models.tasks.sequence.data import SLACK_S, TaskSequence

_ROUNDING = 2.0**-40


def relaxed_bound(data: TaskSequence) -> float:
    """Return a lower bound on the total cost of all feasible routes.

    Parameters
    ----------
    data
        The problem.

    Returns
    -------
    The bound, in s; +inf if it proves that there are no feasible routes.
    """
    first_s, first_extra_s, stowing_s = from_robots(data)
    next_s, next_extra_s, storing_s = _from_tasks(data)
    arrive_s = _earliest(data, first_s, next_s)
    # who arrives too late, or finds no place, cannot do the task
    possible = (arrive_s <= data.latest_s + SLACK_S) & np.isfinite(arrive_s + storing_s)
    timed = possible & np.isfinite(data.due_s)
    late_s = np.where(possible, 0.0, math.inf)
    late_s[timed] = data.late_weight * np.maximum(0.0, arrive_s[timed] - data.due_s[timed])
    later = np.full((data.tasks, data.tasks), math.inf)
    np.fill_diagonal(later, data.skip_s)
    own_s = (data.bring_s + np.where(np.isinf(storing_s), 0.0, storing_s) + late_s)[:, np.newaxis]
    pairs = np.hstack([first_extra_s.T + own_s, next_extra_s.T + own_s, later])
    assigned = assign(pairs)
    if assigned is None or np.isinf(stowing_s).any():
        return math.inf
    total = assigned.bound + math.fsum(stowing_s)
    return total - _ROUNDING * abs(total)


def from_robots(
    data: TaskSequence,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return times of the drives from the robots' initial positions to the pods of the tasks.

    If a robot carries a pod, it stores this pod before it fetches the next one; the place is the
    one that makes the whole drive shortest. The *storing time* of such a robot is the duration of
    the drive to the storage location nearest to it; that of other robots is 0.

    Parameters
    ----------
    data
        The problem.

    Returns
    -------
    Three arrays, in s, infinite for drives that are not allowed: the earliest time at which each
    robot can be at the pod of each task, shape (R, T); the duration of this drive minus the storing
    time, shape (R, T); and the storing time of each robot, shape (R,).
    """
    through_s = shortest_over_places(data.stow_s, data.fetch_s)
    stowing_s = np.where(data.carrying, data.stow_s.min(axis=1, initial=math.inf), 0.0)
    way_s = np.where(data.carrying[:, np.newaxis], through_s, data.reach_s)
    known = np.where(np.isinf(stowing_s), 0.0, stowing_s)[:, np.newaxis]
    return data.ready_s[:, np.newaxis] + way_s, way_s - known, stowing_s


def _from_tasks(
    data: TaskSequence,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return times of the drives from the stations of tasks to the pods of next tasks.

    As in `from_robots`, there are three arrays, in s: the time from the arrival at the station of
    each task to the arrival at each other pod, shape (T, T); the duration of the drive minus the
    storing time, shape (T, T); and the storing time, shape (T,).
    """
    through_s = shortest_over_places(data.store_s, data.fetch_s)
    np.fill_diagonal(through_s, math.inf)
    storing_s = data.store_s.min(axis=1, initial=math.inf)
    known = np.where(np.isinf(storing_s), 0.0, storing_s)[:, np.newaxis]
    return data.service_s[:, np.newaxis] + through_s, through_s - known, storing_s


def _earliest(
    data: TaskSequence, first_s: NDArray[np.float64], next_s: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the earliest arrival of each pod over all chains of tasks, shape (T,), in s."""
    start_s = np.maximum(first_s.min(axis=0, initial=math.inf) + data.bring_s, data.earliest_s)
    arrive_s: NDArray[np.float64] = start_s
    for _ in range(data.tasks):
        chained = (arrive_s[:, np.newaxis] + next_s).min(axis=0, initial=math.inf) + data.bring_s
        sooner = np.minimum(arrive_s, np.maximum(chained, data.earliest_s))
        if np.array_equal(sooner, arrive_s):
            break
        arrive_s = sooner
    return arrive_s
