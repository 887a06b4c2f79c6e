"""The joint decision for a real site: start from the rule, improve exactly, and bound.

This is what a controller calls. Pod match looks at all pairs; CP-SAT then decides a few stations at
a time anew, over pruned pairs, within its deterministic limit. The bound is one of the full input.
"""

from __future__ import annotations

import time
from dataclasses import replace

from rmfs.solvers.models.pile_on import greedy, neighbourhood, prices
from rmfs.solvers.models.pile_on.candidates import Pruning, everything, prune
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.restrict import compact
from rmfs.solvers.models.pile_on.values import Assignment, objective
from rmfs.solvers.models.solution import Limits, Solution, Status

NAME = "joint"
DEFAULT_LIMITS = Limits(deterministic_s=0.05)
SCORED_PER_S = 1e7
"""Candidates that the rule scores in about a deterministic second."""


def solve(
    data: PileOn,
    limits: Limits = DEFAULT_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    pruning: Pruning | None = None,
    bound_steps: int = prices.ITERATIONS,
) -> Solution[Assignment]:
    """Decide orders, pods and robots together.

    Parameters
    ----------
    data
        The input.
    limits
        As for `neighbourhood.solve`. Default: 0.05 deterministic seconds.
    seed
        Seed of CP-SAT. Default 0.
    start
        A further decision to start from. Default: only the rule's own.
    pruning
        How many candidates CP-SAT is given. Default: those of `Pruning`.
    bound_steps
        Steps of `prices.bound`; 0 still gives a bound, a weaker one. Default `prices.ITERATIONS`.

    Returns
    -------
    A feasible decision, never worse than pod match or the start, with a bound of the full input.
    Its work is what the decision took (the bound is for the record): deterministic seconds of
    CP-SAT, and candidates scored by the rule at `SCORED_PER_S`.
    """
    began = time.perf_counter()
    small = compact(data, everything(data))
    rule = greedy.solve(small.data, candidates=small.candidates)
    starts = [rule.required]
    if start is not None:
        starts.append(small.shrink(start))
    best = min(starts, key=lambda values: objective(small.data, values))
    ruled_s = time.perf_counter() - began
    candidates = prune(small.data, pruning)
    pruned_s = time.perf_counter() - began - ruled_s
    found = neighbourhood.solve(small.data, limits, seed=seed, start=best, candidates=candidates)
    values = small.expand(found.required)
    cost = objective(data, values)
    bound = prices.bound(small.data, cost, bound_steps)
    optimal = cost - bound <= limits.gap * abs(cost)
    return replace(
        found,
        values=values,
        objective=cost,
        bound=bound,
        status=Status.OPTIMAL if optimal else Status.FEASIBLE,
        backend=NAME,
        wall_s=time.perf_counter() - began,
        build_s=found.build_s + pruned_s,
        work=found.work + rule.work / SCORED_PER_S,
    )
