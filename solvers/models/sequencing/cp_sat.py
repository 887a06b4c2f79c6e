"""Rack sequencing by CP-SAT, for plans with at most as many visits as a heuristic plan."""

from __future__ import annotations

import math
import time
from dataclasses import replace

from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.backends.backend import solve_by
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.sequencing import beam
from rmfs.solvers.models.sequencing.bounds import visits_bound
from rmfs.solvers.models.sequencing.data import Sequencing, VisitSequence, objective, violations
from rmfs.solvers.models.sequencing.local_search import merged
from rmfs.solvers.models.sequencing.program import formulate
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status


def solve(
    data: Sequencing,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: VisitSequence | None = None,
) -> Solution[VisitSequence]:
    """Find a plan with the fewest visits.

    Of the limits, `deterministic_s` and `gap` apply. The solver starts from `start` or, if it is
    not given, from the plan of `beam`.
    """
    began = time.perf_counter()
    if not data.feasible:
        return Solution(None, math.inf, math.inf, Status.INFEASIBLE, cp_sat.NAME)
    first = beam.solve(data, seed=seed).required if start is None else start
    broken = violations(data, first)
    require(not broken, "start", "; ".join(broken))
    first = merged(first)
    least, visits = visits_bound(data), objective(data, first)
    if least >= visits:
        wall_s = time.perf_counter() - began
        return Solution(first, visits, visits, Status.OPTIMAL, cp_sat.NAME, wall_s)
    found = solve_by(
        cp_sat.solve,
        lambda: formulate(data, first.pods.size, int(least)),
        limits,
        seed=seed,
        start=first,
    )
    # a limit that comes very soon leaves no bound at all
    bound = max(least, float(math.ceil(max(found.bound, 0.0) - 1e-6)))
    status = Status.OPTIMAL if bound >= found.objective else found.status
    return replace(
        found,
        bound=min(bound, found.objective),
        status=status,
        wall_s=time.perf_counter() - began,
    )
