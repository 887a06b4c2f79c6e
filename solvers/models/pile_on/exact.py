"""What all back ends of the pile-on models share: candidates, start, fall-back, solution."""

from __future__ import annotations

import math
import time
from dataclasses import replace

from rmfs.solvers.models.backends.backend import Backend, at_least
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.pile_on.candidates import Candidates, everything
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.program import formulate
from rmfs.solvers.models.pile_on.values import Assignment, nothing, objective, violations
from rmfs.solvers.models.solution import Limits, Solution, Status


def solve_with(
    backend: Backend,
    data: PileOn,
    limits: Limits,
    *,
    seed: int,
    start: Assignment | None,
    candidates: Candidates | None,
    strengthen: bool,
) -> Solution[Assignment]:
    """Formulate and solve; the start is the answer if the solver finds nothing better.

    Parameters
    ----------
    backend
        The adapter to call.
    data
        The input.
    limits
        When to stop.
    seed
        Seed of the solver.
    start
        A feasible decision, or None for "decide nothing".
    candidates
        The pairs to use, None for all. With a proper subset there is no bound (-inf).
    strengthen
        Whether to add the strengthening rows.

    Returns
    -------
    The solution; always with values.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    began = time.perf_counter()
    fallback = nothing(data) if start is None else start
    broken = violations(data, fallback)
    require(not broken, "start", "; ".join(broken))
    pairs = everything(data) if candidates is None else candidates.including(fallback)
    formulation = formulate(data, pairs, strengthen=strengthen)
    point = None if start is None else formulation.encode(start)
    outcome = backend(formulation.program, limits, seed=seed, start=point)
    solution = outcome.solution(
        formulation.decode,
        lambda values: objective(data, values),
        build_s=time.perf_counter() - began - outcome.wall_s,
    )
    if candidates is not None and solution.found:
        # The best of the pruned pairs proves nothing about the others.
        solution = replace(solution, bound=-math.inf, status=Status.FEASIBLE)
    worth = objective(data, fallback)
    return at_least(solution, fallback, worth)
