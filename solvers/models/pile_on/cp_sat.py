"""The pile-on models with CP-SAT: the back end for decisions under a deterministic time limit."""

from __future__ import annotations

from functools import partial

from rmfs.solvers.models.backends import cp_sat
from rmfs.solvers.models.pile_on.candidates import Candidates
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.exact import solve_with
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
    """Decide with CP-SAT.

    Parameters
    ----------
    data
        The input.
    limits
        ``deterministic_s`` and ``gap`` apply. Default: to optimality.
    seed
        Seed of the solver. Default 0.
    start
        A feasible decision to start from; the result is never worse. Default: none.
    candidates
        The pairs to use. Default: all. With pruned pairs the bound is -inf.
    strengthen
        Whether to add the strengthening rows (8). Default: yes.

    Returns
    -------
    The solution; always with values.
    """
    return solve_with(
        # The formulation is tight as it stands: presolving takes longer than it saves.
        partial(cp_sat.solve, presolve=False),
        data,
        limits,
        seed=seed,
        start=start,
        candidates=candidates,
        strengthen=strengthen,
    )
