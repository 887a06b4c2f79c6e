"""Stays choose zones in descending order of the cost difference between zones, per hour of stay.

If a stay finds no zone, all stays choose again, in the order in which they begin.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule
from rmfs.solvers.models.storage.stays.data import Stays, objective


def solve(
    data: Stays,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Solution[NDArray[np.int64]]:
    """Give each stay the cheapest zone that has room during the whole stay.

    The stays choose in sequence. Those with only one allowed zone come first, then those with the
    largest cost difference between their worst and their best zone, divided by the length of the
    stay: a good place is better used by several short stays than by a long one. If a stay finds no
    zone, all stays choose again, in the order in which they begin. This second sequence can fail
    only if a zone is forbidden for some stay, or if the zones together have too few places. The
    bound is computed as if zones had room for any number of stays.

    Returns
    -------
    The zone of each stay, shape (S,); ties go to the lowest index. The status is INFEASIBLE if no
    zone is allowed for some stay, and LIMIT if both sequences fail for another reason.
    """
    begin = perf_counter()
    stays, zones = data.cost_s.shape
    bound = float(data.cost_s.min(axis=1, initial=math.inf).sum())
    zone, tried = None, 0
    for order in (_at_stake(data), np.argsort(data.begin_s, kind="stable")):
        zone, tried = _place(data, order.tolist()), tried + 1
        if zone is not None:
            break
    return solution_of_rule(
        zone,
        lambda values: objective(data, values),
        bound=bound,
        work=float(tried * stays * zones),
        began=begin,
    )


def _at_stake(data: Stays) -> NDArray[np.intp]:
    """Sort stays by the cost difference of their worst and best zone per second, largest first."""
    allowed = np.isfinite(data.cost_s)
    worst = np.where(allowed, data.cost_s, -math.inf).max(axis=1, initial=-math.inf)
    best = data.cost_s.min(axis=1, initial=math.inf)
    # a stay without a choice is certain to need its zone
    stake = np.where(allowed.sum(axis=1) > 1, worst - best, math.inf)
    return np.argsort(-stake / (data.end_s - data.begin_s), kind="stable")


def _place(data: Stays, order: Iterable[int]) -> NDArray[np.int64] | None:
    """Give stays their zones in the given order; return None if one finds no zone."""
    first, last, periods = data.periods
    room = np.repeat(data.capacity[:, np.newaxis], periods, axis=1)
    zone = np.full(len(data.cost_s), -1, np.int64)
    for stay in order:
        during = slice(first[stay], last[stay])
        free = room[:, during].min(axis=1) > 0 if len(room) else np.zeros(0, bool)
        cost_s = np.where(free, data.cost_s[stay], math.inf)
        best = int(cost_s.argmin()) if cost_s.size else -1
        if best < 0 or math.isinf(cost_s[best]):
            return None
        zone[stay] = best
        room[best, during] -= 1
    return zone
