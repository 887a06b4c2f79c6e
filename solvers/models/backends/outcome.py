"""The raw result of a back end, before a model interprets it: columns, bounds and work."""

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
"""What a floating-point MIP solver may be off by, relative; its bounds are lowered by this."""


@dataclass(frozen=True)
class Outcome:
    """The end of one solve of a `LinearProgram`.

    Parameters
    ----------
    x
        Value per column; None if nothing feasible was found.
    bound
        Proven lower bound of the objective, offset included; -inf if none.
    status
        How it ended.
    backend
        Name of the adapter.
    work
        Deterministic work in the back end's unit.
    build_s, wall_s
        Wall-clock seconds for handing over, and for the whole call.
    built
        Nonzeros handed over.
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
        """Turn columns into a model's values, with the objective recomputed from them.

        Parameters
        ----------
        decode
            Makes values of the columns.
        objective
            The model's own objective function.
        build_s
            Seconds the model spent before the adapter was called; added to both times.

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
    """The end of one relaxed solve.

    Parameters
    ----------
    x
        Value per column, fractional and feasible to the solver's tolerance; None if it found none.
    multipliers
        One per row, positive where a lower bound binds; zeros if the solver gave none.
    bound
        Lower bound of the program and of its integer version, rounded to the safe side.
    work
        Iterations of the back end.
    build_s, wall_s
        Seconds for setting parameters (and compiling, the first time), and for the whole call.
    """

    x: NDArray[np.float64] | None
    multipliers: NDArray[np.float64]
    bound: float
    work: float
    build_s: float
    wall_s: float


def trivial(program: LinearProgram, backend: str) -> Outcome | None:
    """Answer a program without columns, which solvers treat in different ways.

    Parameters
    ----------
    program
        The program.
    backend
        Name of the adapter that asks.

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
