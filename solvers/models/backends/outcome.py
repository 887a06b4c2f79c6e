"""The raw result of a back end: column values, bound and work, not yet interpreted by a model."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.program import LinearProgram
from rmfs.solvers.models.solution import Solution, Status

V = TypeVar("V")

NUMERICAL_TOLERANCE = 1e-6
"""Relative error assumed for a floating-point MIP solver; its bounds are lowered by this."""


@dataclass(frozen=True)
class Outcome:
    """The result of solving a `LinearProgram`.

    Parameters
    ----------
    x
        Value of each column; None if no feasible point was found.
    bound
        Proven lower bound on the objective, including the offset; -inf if there is none.
    status
        Final status.
    backend
        Name of the back end.
    work
        Deterministic work in the back end's unit.
    build_s, wall_s
        Wall-clock seconds for passing the program to the solver, and for the whole call.
    built
        Number of nonzeros passed to the solver.
    """

    x: NDArray[np.float64] | None
    bound: float
    status: Status
    backend: str
    work: float
    build_s: float
    wall_s: float
    built: float = 0.0

    def solution(
        self,
        decode: Callable[[NDArray[np.float64]], V],
        objective: Callable[[V], float],
        *,
        build_s: float = 0.0,
    ) -> Solution[V]:
        """Decode the outcome to a solution of the model, and recompute the objective.

        Parameters
        ----------
        decode
            Function that turns column values into the model's values.
        objective
            The model's own objective function.
        build_s
            Seconds spent before the back end was called; they are added to the solution's `build_s`
            and `wall_s`.

        Returns
        -------
        The solution.
        """
        values = None if self.x is None else decode(self.x)
        return Solution(
            values=values,
            objective=math.inf if values is None else objective(values),
            bound=self.bound,
            status=self.status,
            backend=self.backend,
            wall_s=self.wall_s + build_s,
            build_s=self.build_s + build_s,
            work=self.work,
            built=self.built,
        )


@dataclass(frozen=True)
class Relaxation:
    """The result of solving a relaxation.

    Parameters
    ----------
    x
        Value of each column, possibly fractional, feasible within the solver's tolerance; None if
        the solver found no point.
    multipliers
        Dual value of each row, positive where the row's lower bound is binding; zeros if the solver
        gave none.
    bound
        Lower bound on the objective of the relaxation, and so of the integer program. It is lowered
        by an allowance for rounding errors.
    work
        Number of iterations of the solver.
    build_s, wall_s
        Wall-clock seconds for passing the program to the solver (compilation, if any, included),
        and for the whole call.
    """

    x: NDArray[np.float64] | None
    multipliers: NDArray[np.float64]
    bound: float
    work: float
    build_s: float
    wall_s: float


def trivial(program: LinearProgram, backend: str) -> Outcome | None:
    """Return the outcome of a program that has no columns, without calling the solver.

    This avoids differences between solvers in the treatment of such programs.

    Parameters
    ----------
    program
        The program.
    backend
        Name of the back end, to be stored in the outcome.

    Returns
    -------
    The outcome, or None if the program has columns.
    """
    if program.columns:
        return None
    x = np.zeros(0)
    feasible = program.violation(x) == 0.0
    return Outcome(
        x=x if feasible else None,
        bound=program.offset if feasible else math.inf,
        status=Status.OPTIMAL if feasible else Status.INFEASIBLE,
        backend=backend,
        work=0.0,
        build_s=0.0,
        wall_s=0.0,
    )
