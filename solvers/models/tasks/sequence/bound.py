r"""A lower bound: routes are relaxed to pairs of a task and its predecessor.

The relaxation ignores that each place is used at most once and that chains of tasks must begin at a
robot; and it takes the earliest possible arrival of each task instead of the actual one. An
assignment problem remains: task t follows robot r or task o, or is left. With
:math:`s_o = \min_l store_{ol}`, following o costs

.. math::

    \min_l (store_{ol} + fetch_{lt}) - s_o + bring_t + s_t + w \max(0, e_t - due_t)

where w is the weight of lateness and :math:`e_t` is the earliest arrival at the station of t over
all chains; the other symbols are those of `TaskSequence`. The first difference is the time that the
drive to the pod of t adds to storing the pod of o at its nearest place; :math:`s_o` itself is part
of the cost of o.
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
    """Return a lower bound on the total cost of every feasible plan of routes.

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
    """Return the times of the robots' drives to the pods of tasks that they may do first.

    Robots that carry a pod drive via the best place, where they store it.

    Parameters
    ----------
    data
        The problem.

    Returns
    -------
    Three arrays, in s, infinite for drives that are not allowed: the time at which each robot can
    be at the pod of each task, shape (R, T); its drive there less its storing drive, shape (R, T);
    and its storing drive, shape (R,). On the storing drive, the robot takes the pod that it carries
    to the nearest place (the time is 0 if it carries none).
    """
    through_s = shortest_over_places(data.stow_s, data.fetch_s)
    stowing_s = np.where(data.carrying, data.stow_s.min(axis=1, initial=math.inf), 0.0)
    way_s = np.where(data.carrying[:, np.newaxis], through_s, data.reach_s)
    known = np.where(np.isinf(stowing_s), 0.0, stowing_s)[:, np.newaxis]
    return data.ready_s[:, np.newaxis] + way_s, way_s - known, stowing_s


def _from_tasks(
    data: TaskSequence,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the time from one station to the next pod, what it adds, and storing itself."""
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
