"""Common interface between models and solvers of integer programmes."""

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
    """A solver of integer programmes: the signature of `highs.solve` and `cp_sat.solve`."""

    def __call__(
        self,
        program: LinearProgram,
        limits: Limits,
        *,
        seed: int,
        start: NDArray[np.float64] | None,
    ) -> Outcome:
        """Solve a programme."""


@dataclass(frozen=True)
class Formulation(Generic[V]):
    """A problem as an integer programme.

    Attributes
    ----------
    program
        The programme.
    encode
        Writes values as columns of the programme.
    decode
        Reads values off the columns.
    objective, violations
        The model's own.
    names
        Says what each column is called, and what it decides: see `Names`.
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
    """State the programme, check the start, hand both over, and read the answer.

    Parameters
    ----------
    backend
        The solver.
    formulate
        States the programme; its time counts as building.
    limits, seed
        As the back ends say.
    start
        Values to start from, or None.

    Returns
    -------
    What the solver found; never worse than the start.

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
    """Return the start if a search has found nothing, or nothing better, before its limit.

    Parameters
    ----------
    found
        What the search found; a minimum.
    start
        Feasible values.
    value
        Their objective.
    """
    if found.found and found.objective <= value:
        return found
    status = Status.OPTIMAL if found.status is Status.OPTIMAL else Status.FEASIBLE
    return replace(found, values=start, objective=value, status=status)


def relax(program: LinearProgram, limits: Limits = NO_LIMITS, *, seed: int = 0) -> Outcome:
    """Solve a programme without whole numbers by HiGHS; its bound is one for the programme.

    Parameters
    ----------
    program
        The programme.
    limits
        `iterations` of the simplex. Default: none.
    seed
        Seed of the solver. Default 0.
    """
    relaxed = replace(program, integer=np.zeros(program.columns, bool))
    return highs.solve(relaxed, limits, seed=seed)


def with_relaxed_bound(backend: Backend) -> Backend:
    """Give searches that their limit ended the bound of the relaxation, if that is better.

    Parameters
    ----------
    backend
        The solver. The simplex iterations of the relaxation do not count as work of its search.
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
        return replace(
            outcome,
            bound=max(outcome.bound, relaxed.bound),
            wall_s=outcome.wall_s + relaxed.wall_s,
        )

    return solve
