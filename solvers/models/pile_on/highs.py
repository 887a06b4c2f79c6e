"""The pile-on models with HiGHS: the back end for proofs and for bounds at the root."""

from __future__ import annotations

from rmfs.solvers.models.backends import highs
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
    """Decide with HiGHS.

    Parameters
    ----------
    data
        The input.
    limits
        ``nodes`` and ``gap`` apply. Default: to optimality.
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
        highs.solve,
        data,
        limits,
        seed=seed,
        start=start,
        candidates=candidates,
        strengthen=strengthen,
    )
