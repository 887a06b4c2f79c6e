"""Common interface between models and solvers of integer programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends import highs
from rmfs.solvers.models.backends.outcome import Outcome
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import LinearProgram
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

V = TypeVar("V")


class Backend(Protocol):
    """The signature of functions that solve integer programs, such as `highs.solve`."""

    def __call__(
        self,
        program: LinearProgram,
        limits: Limits,
        *,
        seed: int,
        start: NDArray[np.float64] | None,
    ) -> Outcome:
        """Solve a program."""


@dataclass(frozen=True)
class Formulation(Generic[V]):
    """A problem formulated as an integer program.

    Attributes
    ----------
    program
        The integer program.
    encode
        Function that turns the model's values into column values.
    decode
        Function that turns column values into the model's values.
    objective, violations
        Functions of the model's values: the first returns their objective, the second describes
        the constraints that they violate.
    names
        Function that enters, in the `Names` passed to it, the name and meaning of each column.
        Default: enters nothing.
    """

    program: LinearProgram
    encode: Callable[[V], NDArray[np.float64]]
    decode: Callable[[NDArray[np.float64]], V]
    objective: Callable[[V], float]
    violations: Callable[[V], list[str]]
    names: Callable[[Names], None] = lambda names: None


def solve_by(
    backend: Backend,
    formulate: Callable[[], Formulation[V]],
    limits: Limits,
    *,
    seed: int,
    start: V | None,
) -> Solution[V]:
    """Formulate the program, check the start, run the solver, and decode the result.

    Parameters
    ----------
    backend
        The solver.
    formulate
        Function that formulates the program; the time it takes counts as building time.
    limits, seed
        Passed to the back end.
    start
        Feasible values to start from, or None.

    Returns
    -------
    The solver's solution. If the solver finds no values, or values worse than the start, the start
    takes their place.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    begin = perf_counter()
    formulation = formulate()
    point = None
    if start is not None:
        broken = formulation.violations(start)
        require(not broken, "start", "; ".join(broken))
        point = formulation.encode(start)
    built_s = perf_counter() - begin
    outcome = backend(formulation.program, limits, seed=seed, start=point)
    found = outcome.solution(formulation.decode, formulation.objective, build_s=built_s)
    return found if start is None else at_least(found, start, formulation.objective(start))


def at_least(found: Solution[V], start: V, value: float) -> Solution[V]:
    """Return the result of a minimisation, with values that are no worse than the start.

    The start replaces the values if the search found none, or if those found are worse.

    Parameters
    ----------
    found
        Result of the search.
    start
        Feasible values.
    value
        Objective of the start.
    """
    if found.found and found.objective <= value:
        return found
    status = Status.OPTIMAL if found.status is Status.OPTIMAL else Status.FEASIBLE
    return replace(found, values=start, objective=value, status=status)


def relax(program: LinearProgram, limits: Limits = NO_LIMITS, *, seed: int = 0) -> Outcome:
    """Solve the linear relaxation with HiGHS; the bound is also valid for the integer program.

    Parameters
    ----------
    program
        The integer program.
    limits
        `iterations` limits the simplex method. Default: no limit.
    seed
        Seed of the solver. Default 0.
    """
    relaxed = replace(program, integer=np.zeros(program.columns, bool))
    return highs.solve(relaxed, limits, seed=seed)


def with_relaxed_bound(backend: Backend) -> Backend:
    """Return a back end that adds the bound of the linear relaxation if a limit ends its search.

    The outcome then contains the larger of this bound and the solver's own bound; it is INFEASIBLE
    if the relaxation is. The work that it states does not include the work for the relaxation.

    Parameters
    ----------
    backend
        The solver.
    """

    def solve(
        program: LinearProgram,
        limits: Limits,
        *,
        seed: int,
        start: NDArray[np.float64] | None,
    ) -> Outcome:
        outcome = backend(program, limits, seed=seed, start=start)
        if outcome.status not in (Status.FEASIBLE, Status.LIMIT):
            return outcome
        relaxed = relax(program)
        hopeless = outcome.x is None and relaxed.status is Status.INFEASIBLE
        return replace(
            outcome,
            bound=max(outcome.bound, relaxed.bound),
            status=Status.INFEASIBLE if hopeless else outcome.status,
            wall_s=outcome.wall_s + relaxed.wall_s,
        )

    return solve
