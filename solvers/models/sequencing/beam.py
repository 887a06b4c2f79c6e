"""Beam search followed by a local search, for inputs too large for the exact methods.

In each step, every kept partial plan is extended by a visit of each pod in turn, and the best few
of the extended plans are kept. There are two extensions for each plan and pod. The first fills free
slots with new orders for which the pod holds some, but not all, of the SKUs; the orders that then
lack the fewest SKUs come first. The second does the same, but only with orders for which the pod
holds at least half of the SKUs. Plans are ranked by the total number of SKUs that their orders
still lack; SKUs of open orders count twice, because an open order occupies a slot. All plans of a
step are scored together, by one matrix product. The search is deterministic: ties go to the first
kind of extension, then to the extension of the plan that ranked higher in the previous step, then
to the pod with the lower index.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.sequencing import local_search
from rmfs.solvers.models.sequencing.bounds import visits_bound
from rmfs.solvers.models.sequencing.data import (
    Flags,
    Integers,
    Sequencing,
    VisitSequence,
    objective,
    violations,
)
from rmfs.solvers.models.sequencing.sets import useful_pods
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

WIDTH = 20
"""Number of partial plans kept per visit."""


def solve(
    data: Sequencing,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: VisitSequence | None = None,
    width: int = WIDTH,
) -> Solution[VisitSequence]:
    """Find a plan with few visits by beam search, followed by local search.

    Parameters
    ----------
    data
        The input.
    limits
        ``iterations`` limits the moves of the local search. Default: `local_search.MOVES`.
    seed
        Seed of the local search. Default 0.
    start
        A feasible plan; the result never has more visits. Default: none.
    width
        Number of partial plans kept per visit. Default `WIDTH`.

    Returns
    -------
    A feasible plan, with the bound of `visits_bound`; status INFEASIBLE if there is no plan.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    began = time.perf_counter()
    if not data.feasible:
        return Solution(None, math.inf, math.inf, Status.INFEASIBLE, "rule")
    broken = [] if start is None else violations(data, start)
    require(not broken, "start", "; ".join(broken))
    plan, scored = search(data, width)
    if start is not None and objective(data, start) < objective(data, plan):
        plan = start
    plan, moves = local_search.improve(data, plan, limits.iterations, seed)
    bound = min(visits_bound(data), objective(data, plan))
    return Solution(
        values=plan,
        objective=objective(data, plan),
        bound=bound,
        status=Status.OPTIMAL if bound == objective(data, plan) else Status.FEASIBLE,
        backend="rule",
        wall_s=time.perf_counter() - began,
        work=float(scored + moves),
    )


def search(data: Sequencing, width: int) -> tuple[VisitSequence, int]:
    """Run the beam search without the local search.

    Parameters
    ----------
    data
        The input, which must be feasible.
    width
        Number of partial plans kept per visit, at least 1.

    Returns
    -------
    A feasible plan, and the number of candidate visits scored.
    """
    pods = useful_pods(data)
    holds = data.holds[pods].astype(np.float32)
    kept = [_Partial(data.needs, data.open, (), np.full(data.orders, -1))]
    scored = 0
    for visit in range(int(data.needs.sum()) + 1):
        for plan in kept:
            if not plan.missing.any():
                return VisitSequence(pods[list(plan.pods)], plan.start), scored
        kept = _next(data, kept, holds, visit, width)
        scored += len(kept) * pods.size
    raise AssertionError("every visit of the best plan serves somebody")


@dataclass(frozen=True)
class _Partial:
    """A plan so far: SKUs missing (O, K), orders started (O,), pods and starts."""

    missing: Flags
    started: Flags
    pods: tuple[int, ...]
    start: Integers


def _next(
    data: Sequencing, kept: list[_Partial], holds: NDArray[np.float32], visit: int, width: int
) -> list[_Partial]:
    """Extend each kept plan by a visit of each pod; return the `width` best different plans."""
    missing = np.stack([plan.missing for plan in kept]).astype(np.float32)
    started = np.stack([plan.started for plan in kept])[:, None, :]
    lacks = missing.sum(axis=2)[:, None, :]
    brings = np.swapaxes(missing @ holds.T, 1, 2)  # (plans, pods, orders)
    left = lacks - brings
    open_now = started & (lacks > 0)
    free = data.capacity - (open_now & (left > 0)).sum(axis=2, keepdims=True)
    passing = ~started & (lacks > 0) & (left == 0) & (free > 0)
    waiting = ~started & (brings > 0) & (left > 0)
    branches = []
    for wanted in (waiting, waiting & (brings >= left)):
        # Fewest SKUs missing first, then the lower order; `rank` is the place in that line.
        rank = np.argsort(np.argsort(np.where(wanted, left, np.inf), axis=2, kind="stable"), axis=2)
        served = open_now | passing | (wanted & (rank < free))
        after = np.where(served, left, lacks)
        holding = (started | served) & (after > 0)
        score = after.sum(axis=2) + (after * holding).sum(axis=2)
        idle = ~(served & (brings > 0)).any(axis=2)
        branches.append((np.where(idle, np.inf, score), served))
    scores = np.stack([score for score, _ in branches])
    best: list[_Partial] = []
    seen: set[bytes] = set()
    for place in np.argsort(scores, axis=None, kind="stable"):
        branch, parent, pod = (int(i) for i in np.unravel_index(place, scores.shape))
        if len(best) == width or np.isinf(scores[branch, parent, pod]):
            break
        plan = _after(kept[parent], branches[branch][1][parent, pod], holds[pod], pod, visit)
        key = plan.missing.tobytes() + plan.started.tobytes()
        if key not in seen:
            seen.add(key)
            best.append(plan)
    return best


def _after(
    plan: _Partial, served: Flags, held: NDArray[np.float32], pod: int, visit: int
) -> _Partial:
    """The plan after one more visit."""
    missing = plan.missing & ~(served[:, None] & (held > 0))
    fresh = served & ~plan.started
    start = np.where(fresh, visit, plan.start)
    return _Partial(missing, plan.started | served, (*plan.pods, pod), start)
