"""The decision for a real site: start from the rule, improve exactly, and bound.

This is what controllers ask. Pod match looks at all pairs; CP-SAT then decides a few stations at a
time anew, over pruned pairs, within its deterministic limit. The bound is one of the full input.
"""

from __future__ import annotations

import time
from dataclasses import replace

from rmfs.solvers.models.pile_on import greedy, neighbourhood, prices
from rmfs.solvers.models.pile_on.candidates import Pruning, prune
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.values import Assignment, objective
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: PileOn,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    pruning: Pruning | None = None,
    bound_steps: int = prices.ITERATIONS,
) -> Solution[Assignment]:
    """Decide orders, pods and robots together; limits as for `neighbourhood.solve`.

    Parameters
    ----------
    data, limits, seed
        As for every method.
    start
        A further decision to start from. Default: only the rule's own.
    pruning
        How many candidates CP-SAT is given. Default: those of `Pruning`.
    bound_steps
        Steps of `prices.bound`; 0 still gives a bound, a weaker one. Default `prices.ITERATIONS`.

    Returns
    -------
    A feasible decision, never worse than pod match or the start, with a bound of the full input.
    Its work is deterministic seconds of CP-SAT, within the limit but for the step in which it ends;
    what grows with the input, rule and bound included, is in `built`.
    """
    began = time.perf_counter()
    rule = greedy.solve(data, seed=seed)
    best = rule.required
    if start is not None and objective(data, start) < rule.objective:
        best = start
    pairs = prune(data, pruning).including(best)
    pruned_s = time.perf_counter() - began - rule.wall_s
    found = neighbourhood.solve(data, limits, seed=seed, start=best, candidates=pairs)
    found = prices.bounded(data, found, bound_steps, limits.gap)
    return replace(
        found,
        wall_s=time.perf_counter() - began,
        build_s=found.build_s + pruned_s,
        built=found.built + rule.built,
    )
