"""The method for sites of realistic size: start from a heuristic, improve exactly, and bound.

Controllers use this method. Pod match (`greedy`) looks at all pairs; CP-SAT then re-optimises a few
stations at a time over pruned pairs, within its deterministic limit. The bound is valid for the
full input.
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
    """Decide on orders, pods and robots together; limits as for `neighbourhood.solve`.

    Parameters
    ----------
    data, limits, seed
        As for every method.
    start
        A decision to start from if it is better than that of pod match. Default: none.
    pruning
        How many candidates CP-SAT is given. Default: the defaults of `Pruning`.
    bound_steps
        Number of steps of `prices.bound`; 0 gives a weaker bound. Default `prices.ITERATIONS`.

    Returns
    -------
    A feasible decision, never worse than pod match or the start, with a bound of the full input.
    Its work is measured in deterministic seconds of CP-SAT, whose last run may exceed the limit.
    The effort of building the programs, and that of pod match, are counted in `built`; the steps
    for the bound are not counted.
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
