"""Linear relaxations through cvxpy and Clarabel, compiled once and solved repeatedly.

A relaxation is compiled for a *pattern*: the positions of the nonzeros of the matrix, and which
rows have lower and upper bounds. Every number (costs, coefficients, bounds) is a `cvxpy.Parameter`,
so further programs with the same pattern are solved without compiling (disciplined parametrised
programming). Interior-point duals are inexact; `safe_bound` computes a bound from them that is
valid despite their errors.
"""

from __future__ import annotations

import time
import warnings

import cvxpy as cp
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from rmfs.solvers.models.backends.outcome import Relaxation as Relaxation
from rmfs.solvers.models.backends.safe_bound import safe_bound
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.program import LinearProgram
from rmfs.solvers.models.solution import NO_LIMITS, Limits, WallGuardError

NAME = "clarabel"
_DEFAULT_ITERATIONS = 200


class LinearRelaxation:
    """A compiled linear relaxation, to be solved for any program with the same pattern.

    Parameters
    ----------
    program
        A program with the pattern (see the module); its numbers are not used.
    """

    def __init__(self, program: LinearProgram) -> None:
        self._pattern = _pattern(program)
        self._lower_rows = np.flatnonzero(np.isfinite(program.row_lower))
        self._upper_rows = np.flatnonzero(np.isfinite(program.row_upper))
        rows = np.repeat(np.arange(program.rows), np.diff(program.row_start))
        self._places = (rows, np.asarray(program.column))
        self._x = cp.Variable(program.columns)
        self._cost = cp.Parameter(program.columns)
        self._box = (cp.Parameter(program.columns), cp.Parameter(program.columns))
        self._row_lower = cp.Parameter(self._lower_rows.size)
        self._row_upper = cp.Parameter(self._upper_rows.size)
        self._constraints: list[cp.Constraint] = [self._x >= self._box[0], self._x <= self._box[1]]
        self._matrix: cp.Parameter | None = None
        if program.nonzeros:
            self._matrix = cp.Parameter((program.rows, program.columns), sparsity=self._places)
            activity = self._matrix @ self._x
            self._constraints += [
                activity[self._lower_rows] >= self._row_lower,
                activity[self._upper_rows] <= self._row_upper,
            ]
        self._problem = cp.Problem(cp.Minimize(self._cost @ self._x), self._constraints)

    def fits(self, program: LinearProgram) -> bool:
        """Return whether a program has the pattern for which this relaxation was compiled."""
        return self._pattern == _pattern(program)

    def solve(self, program: LinearProgram, limits: Limits = NO_LIMITS) -> Relaxation:
        """Solve the linear relaxation of a program.

        Parameters
        ----------
        program
            A program with the same pattern.
        limits
            ``iterations`` limits the interior-point method. Default: 200 iterations.

        Returns
        -------
        The solution of the relaxation, with a bound that is valid even if the solver failed.

        Raises
        ------
        ModelError
            If the program has another pattern.
        WallGuardError
            If the solver took longer than `limits.wall_guard_s`.
        """
        began = time.perf_counter()
        require(
            self.fits(program),
            "program",
            "has a different sparsity pattern from the compiled relaxation",
        )
        self._set(program)
        built = time.perf_counter()
        x, multipliers, iterations = None, np.zeros(program.rows), 0
        # Without a point and duals the box alone still bounds the objective.
        if self._run(limits):
            iterations = int(self._problem.solver_stats.num_iters or 0)
            x = None if self._x.value is None else np.array(self._x.value)
            multipliers = self._multipliers(program)
        ended = time.perf_counter()
        if limits.wall_guard_s is not None and ended - built > limits.wall_guard_s:
            raise WallGuardError(f"Clarabel took {ended - built:.1f} s")
        return Relaxation(
            x=x,
            multipliers=multipliers,
            bound=safe_bound(program, multipliers),
            work=float(iterations),
            build_s=built - began,
            wall_s=time.perf_counter() - began,
        )

    def _run(self, limits: Limits) -> bool:
        """Call the solver; False if it failed."""
        with warnings.catch_warnings():
            # cvxpy warns about its own reading of the sparse parameter, and about inexact ends.
            warnings.simplefilter("ignore")
            try:
                self._problem.solve(solver=cp.CLARABEL, **_options(limits))  # type: ignore[no-untyped-call]
            except cp.SolverError:
                return False
        return self._problem.solver_stats is not None

    def _set(self, program: LinearProgram) -> None:
        """Fill the parameters."""
        self._cost.value = program.cost
        self._box[0].value, self._box[1].value = program.lower, program.upper
        self._row_lower.value = program.row_lower[self._lower_rows]
        self._row_upper.value = program.row_upper[self._upper_rows]
        if self._matrix is not None:
            shape = (program.rows, program.columns)
            self._matrix.value_sparse = coo_array((program.coefficient, self._places), shape=shape)

    def _multipliers(self, program: LinearProgram) -> NDArray[np.float64]:
        """Row multipliers from the duals of both sides."""
        y = np.zeros(program.rows)
        if self._matrix is not None:
            below, above = self._constraints[2].dual_value, self._constraints[3].dual_value
            if below is not None and above is not None:
                y[self._lower_rows] += np.maximum(below, 0.0)
                y[self._upper_rows] -= np.maximum(above, 0.0)
        return y


def relax(program: LinearProgram, limits: Limits = NO_LIMITS) -> Relaxation:
    """Compile and solve the linear relaxation of a single program.

    Parameters
    ----------
    program
        The program; integrality is ignored.
    limits
        ``iterations`` limits the interior-point method. Default: 200 iterations.

    Returns
    -------
    The solution of the relaxation, with a bound that is valid even if the solver failed.
    """
    began = time.perf_counter()
    relaxation = LinearRelaxation(program)
    compiled = time.perf_counter() - began
    outcome = relaxation.solve(program, limits)
    return Relaxation(
        x=outcome.x,
        multipliers=outcome.multipliers,
        bound=outcome.bound,
        work=outcome.work,
        build_s=outcome.build_s + compiled,
        wall_s=outcome.wall_s + compiled,
    )


def _options(limits: Limits) -> dict[str, float]:
    """Solver options: one thread and the iteration limit."""
    most = _DEFAULT_ITERATIONS if limits.iterations is None else limits.iterations
    return {"max_iter": most, "max_threads": 1}


def _pattern(program: LinearProgram) -> tuple[bytes, bytes, bytes, bytes, int]:
    """Return what two programs must have in common to share a compiled relaxation."""
    return (
        program.row_start.tobytes(),
        program.column.tobytes(),
        np.isfinite(program.row_lower).tobytes(),
        np.isfinite(program.row_upper).tobytes(),
        program.columns,
    )
