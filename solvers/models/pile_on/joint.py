"""The method for sites of realistic size: a heuristic decision, improved by CP-SAT, with a bound.

Controllers use this method. It starts from the decision of the heuristic `greedy`, which considers
all orders and pods. CP-SAT then re-optimises two stations at a time, within the limit
`deterministic_s`. It considers only the candidates that are left after pruning (`candidates`), but
the bound is valid for the full input.
"""

from __future__ import annotations

import time
from dataclasses import replace

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.pile_on import greedy, neighbourhood, prices
from rmfs.solvers.models.pile_on.candidates import Pruning, prune
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.values import Assignment, objective, violations
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
    """Decide on orders, pods and robots together; the limits are those of `neighbourhood.solve`.

    Parameters
    ----------
    data, limits, seed
        As for every method (see `Methods`).
    start
        A decision to start from if it is better than that of `greedy`. Default: none.
    pruning
        How many candidate pairs CP-SAT may use. Default: the defaults of `Pruning`.
    bound_steps
        Number of subgradient steps of `prices.bound`; with 0, the bound is that of the initial
        prices. Default `prices.ITERATIONS`.

    Returns
    -------
    A feasible decision, never worse than that of `greedy` or the start, with a bound that is valid
    for the full input. `work` is measured in deterministic seconds of CP-SAT, whose last run may
    exceed the limit. `built` counts the effort of building the programs and of preparing `greedy`.
    Neither includes the steps for the bound.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    began = time.perf_counter()
    broken = [] if start is None else violations(data, start)
    require(not broken, "start", "; ".join(broken))
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
