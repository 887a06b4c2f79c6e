"""Replenishment, solved by CP-SAT."""

from __future__ import annotations

from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.backends.backend import solve_by, with_relaxed_bound
from rmfs.solvers.models.replenishment.data import Replenishment, Stocking
from rmfs.solvers.models.replenishment.program import formulate
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: Replenishment,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Stocking | None = None,
) -> Solution[Stocking]:
    """Choose pods and stations by constraint programming.

    Of the limits, `deterministic_s` and `gap` apply. If a limit ends the search, the bound is at
    least that of the linear relaxation.
    """
    backend = with_relaxed_bound(cp_sat.solve)
    return solve_by(backend, lambda: formulate(data, whole=True), limits, seed=seed, start=start)
