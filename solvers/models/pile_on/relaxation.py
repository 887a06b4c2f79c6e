"""Lower bounds on the pile-on models from the linear relaxation (cvxpy, Clarabel).

The program, including constraint (8), is relaxed over all pairs; `safe_bound` computes a valid
bound from the dual values. The method suits small and medium sites. At a large site, the matrices
that the interior-point method factorises do not stay sparse; there, the bound that CP-SAT proves on
the full program (`cp_sat.solve` without candidates) is as good and much faster to obtain.
"""

from __future__ import annotations

from rmfs.solvers.models.backends.clarabel import LinearRelaxation, Relaxation
from rmfs.solvers.models.pile_on.candidates import everything
from rmfs.solvers.models.pile_on.data import PileOn
from rmfs.solvers.models.pile_on.program import formulate
from rmfs.solvers.models.solution import NO_LIMITS, Limits


class PileOnRelaxation:
    """Solves linear relaxations of successive inputs; compiles only if the matrix pattern changes.

    The pattern (the positions of the nonzeros) usually stays the same as long as the same pods hold
    SKUs of the same lines, even if costs, weights, quantities or slots change.

    Attributes
    ----------
    compilations
        Number of times a relaxation has been compiled.
    """

    def __init__(self) -> None:
        self.compilations = 0
        self._compiled: LinearRelaxation | None = None

    def solve(self, data: PileOn, limits: Limits = NO_LIMITS) -> Relaxation:
        """Solve the linear relaxation of an input.

        Parameters
        ----------
        data
            The input.
        limits
            ``iterations`` limits the interior-point method.

        Returns
        -------
        The solution of the relaxation, with a bound that is valid even if the solver failed.
        """
        program = formulate(data, everything(data)).program
        if self._compiled is None or not self._compiled.fits(program):
            self._compiled = LinearRelaxation(program)
            self.compilations += 1
        return self._compiled.solve(program, limits)


def bound(data: PileOn, limits: Limits = NO_LIMITS) -> float:
    """Return a lower bound on the objective of every decision.

    Parameters
    ----------
    data
        The input.
    limits
        ``iterations`` limits the interior-point method.
    """
    return PileOnRelaxation().solve(data, limits).bound
