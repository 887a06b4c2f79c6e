"""The pile-on models, solved by CP-SAT."""

from __future__ import annotations

from functools import partial

from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.pile_on.candidates import Candidates
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.program import solve_program
from rmfs.solvers.models.pile_on.values import Assignment
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution


def solve(
    data: PileOn,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Assignment | None = None,
    candidates: Candidates | None = None,
    strengthen: bool = True,
) -> Solution[Assignment]:
    """Solve a pile-on model with CP-SAT; the limits are `deterministic_s` and `gap`.

    Parameters
    ----------
    data, limits, seed, start
        As for every method (see `Methods`).
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
        Default: all. If candidates are given, the bound is -inf.
    strengthen
        Whether to add constraint (8) of `program`, which tightens the relaxation. Default: yes.

    Returns
    -------
    The solution. It always has values, at worst those of the start or of the empty decision.
    """
    # the formulation is tight as it stands: presolving takes longer than it saves
    backend = partial(cp_sat.solve, presolve=False)
    return solve_program(backend, data, limits, seed, start, candidates, strengthen)
