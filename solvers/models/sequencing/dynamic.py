"""Exact dynamic program for small inputs: A* over the missing SKUs of each order.

A state consists of the missing SKUs of each order. If no SKU is missing, the order is complete; if
some are missing, it is open; if all are missing, it has not been started, unless it was open before
the first visit. (The states are those of Justkowiak, Kovalyov, Pesch 2024: completed orders, open
orders, missing SKUs.) A transition is one visit. The pod serves the open orders and, if there is a
free slot, completes all further orders for which it holds every SKU. Of the orders that it can
serve only in part, any subset for which there are slots may be opened.

Each visit costs 1. To estimate the remaining cost, the number of missing SKUs of each order is
divided by the largest number of these SKUs on any one pod and rounded up; the order needs at least
this number of further visits. The maximum over the orders is the estimate. As the estimate is never
too high, the first complete state that is examined is optimal. At any time, a lower bound on the
number of visits is the smallest sum of past visits and estimate over the states not yet examined.
"""

from __future__ import annotations

import heapq
import math
import time
from collections.abc import Iterator
from itertools import combinations

import numpy as np

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.sequencing.data import Sequencing, VisitSequence, objective, violations
from rmfs.solvers.models.sequencing.sets import Sets, reduce
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

State = tuple[tuple[int, ...], int]
"""A state: the missing SKUs of each order, and the bit set of orders that have been started."""


def solve(
    data: Sequencing,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: VisitSequence | None = None,
) -> Solution[VisitSequence]:
    """Find a plan with the fewest visits.

    Parameters
    ----------
    data
        The input. The method is practical up to about ten orders.
    limits
        ``iterations`` limits the number of expanded states. Default: none.
    seed
        Not used, as nothing is random.
    start
        A feasible plan to return if the limit is reached. Default: none.

    Returns
    -------
    An optimal plan. If the limit is reached, the start is returned; without a start, the solution
    has no values and the status LIMIT. The status is INFEASIBLE if no plan exists.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    began = time.perf_counter()
    if not data.feasible:
        return _solution(data, None, math.inf, Status.INFEASIBLE, 0, began)
    broken = [] if start is None else violations(data, start)
    require(not broken, "start", "; ".join(broken))
    sets = reduce(data)
    root: State = (sets.needs, sum(1 << o for o in np.flatnonzero(data.open).tolist()))
    cheapest = {root: 0}
    came_from: dict[State, tuple[State, int]] = {}
    serial, expanded = 0, 0
    queue = [(_estimate(root[0], sets), 0, serial, root)]
    while queue:
        least, _, _, state = heapq.heappop(queue)
        visits = cheapest[state]
        if visits + _estimate(state[0], sets) < least:
            continue  # reached again on a shorter way since
        if not any(state[0]):
            plan = _trace(data, sets, state, came_from)
            return _solution(data, plan, float(visits), Status.OPTIMAL, expanded, began)
        if limits.iterations is not None and expanded >= limits.iterations:
            status = Status.LIMIT if start is None else Status.FEASIBLE
            return _solution(data, start, float(least), status, expanded, began)
        expanded += 1
        for pod, held in enumerate(sets.holds):
            for after in _visit(state, held, sets, data.capacity):
                if cheapest.get(after, visits + 2) > visits + 1:
                    cheapest[after] = visits + 1
                    came_from[after] = (state, pod)
                    serial += 1
                    total = visits + 1 + _estimate(after[0], sets)
                    # Later states first among equals: deeper ones come to an end sooner.
                    heapq.heappush(queue, (total, -visits, -serial, after))
    raise AssertionError("a feasible input always leads to a complete state")


def _visit(state: State, held: int, sets: Sets, capacity: int) -> Iterator[State]:
    """All states after a visit of a pod that holds the given SKUs; none if no order uses it."""
    missing, started = state
    served = list(missing)
    staying = 0
    waiting = []
    passing = []
    for order, lacks in enumerate(missing):
        if not lacks or (not lacks & held and not started >> order & 1):
            continue
        if started >> order & 1:
            served[order] = lacks & ~held
            staying += bool(served[order])
        elif lacks & ~held:
            waiting.append(order)
        else:
            passing.append(order)
    begun = started
    if passing and staying < capacity:
        for order in passing:
            served[order] = 0
            begun |= 1 << order
    for count in range(min(len(waiting), capacity - staying) + 1):
        for chosen in combinations(waiting, count):
            after, now = served.copy(), begun
            for order in chosen:
                after[order] &= ~held
                now |= 1 << order
            if tuple(after) != missing:
                yield tuple(after), now


def _estimate(missing: tuple[int, ...], sets: Sets) -> int:
    """Return the estimate of the remaining visits that the module docstring defines."""
    most = 0
    for lacks in set(missing):
        if lacks:
            best = max((lacks & held).bit_count() for held in sets.holds)
            most = max(most, -(-lacks.bit_count() // best))
    return most


def _trace(
    data: Sequencing, sets: Sets, state: State, came_from: dict[State, tuple[State, int]]
) -> VisitSequence:
    """Follow the transitions back to the root."""
    pods: list[int] = []
    start = np.full(data.orders, -1)
    steps = []
    while state in came_from:
        before, pod = came_from[state]
        steps.append((before, state, pod))
        state = before
    for visit, (before, after, pod) in enumerate(reversed(steps)):
        pods.append(int(sets.pod[pod]))
        fresh = after[1] & ~before[1]
        for order in range(data.orders):
            if fresh >> order & 1:
                start[order] = visit
    return VisitSequence(np.array(pods, dtype=np.int64), start)


def _solution(
    data: Sequencing,
    plan: VisitSequence | None,
    bound: float,
    status: Status,
    expanded: int,
    began: float,
) -> Solution[VisitSequence]:
    """Create the `Solution`."""
    return Solution(
        values=plan,
        objective=math.inf if plan is None else objective(data, plan),
        bound=bound,
        status=status,
        backend="dynamic",
        wall_s=time.perf_counter() - began,
        work=float(expanded),
    )
