"""The joint decision for a real site: prune, start from the better rule, improve exactly.

This is what a controller calls. Feasible always: the rules answer where CP-SAT finds nothing
better within its deterministic limit.
"""

from __future__ import annotations

import time
from dataclasses import replace

from solvers.models.pile_on import greedy, hadgs, neighbourhood
from solvers.models.pile_on.candidates import Pruning, prune
from solvers.models.pile_on.data import PileOn
from solvers.models.pile_on.restrict import compact
from solvers.models.pile_on.values import Assignment, objective
from solvers.models.solution import Limits, Solution

NAME = "joint"
DEFAULT_LIMITS = Limits(deterministic_s=0.05)


def solve(
    data: PileOn,
    limits: Limits = DEFAULT_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    pruning: Pruning | None = None,
) -> Solution[Assignment]:
    """Decide orders, pods and robots together.

    Parameters
    ----------
    data
        The input.
    limits
        As for `neighbourhood.solve`. Default: 0.05 deterministic seconds.
    seed
        Seed of HADGS and CP-SAT. Default 0.
    start
        A further decision to start from. Default: only the rules' own.
    pruning
        How many candidates to keep. Default: those of `Pruning`.

    Returns
    -------
    A feasible decision.
    """
    began = time.perf_counter()
    candidates = prune(data, pruning)
    small = compact(data, candidates if start is None else candidates.including(start))
    pruned_s = time.perf_counter() - began
    rules = [
        rule.solve(small.data, seed=seed, candidates=small.candidates) for rule in (greedy, hadgs)
    ]
    starts = [rule.required for rule in rules]
    if start is not None:
        starts.append(small.shrink(start))
    best = min(starts, key=lambda values: objective(small.data, values))
    solution = neighbourhood.solve(
        small.data, limits, seed=seed, start=best, candidates=small.candidates
    )
    values = small.expand(solution.required)
    return replace(
        solution,
        values=values,
        objective=objective(data, values),
        bound=float("-inf"),
        backend=NAME,
        wall_s=time.perf_counter() - began,
        build_s=solution.build_s + pruned_s,
    )
