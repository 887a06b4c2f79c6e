"""What the back ends have in common: state the programme, hand it over, read the answer."""

from __future__ import annotations

import dataclasses
from time import perf_counter
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from solvers.models.backends import Outcome
from solvers.models.checks import require
from solvers.models.program import LinearProgram
from solvers.models.replenishment.data import Replenishment, Stocking, objective, violations
from solvers.models.replenishment.program import Columns, columns_of, program, stocking_of
from solvers.models.replenishment.relaxation import relax
from solvers.models.solution import Limits, Solution, Status


class Backend(Protocol):
    """A solver of integer programmes."""

    def __call__(
        self,
        program: LinearProgram,
        limits: Limits,
        *,
        seed: int,
        start: NDArray[np.float64] | None,
    ) -> Outcome:
        """Solve a programme."""


def solve_by(
    backend: Backend,
    data: Replenishment,
    limits: Limits,
    seed: int,
    start: Stocking | None,
    *,
    whole: bool,
) -> Solution[Stocking]:
    """Solve the problem by a solver of integer programmes.

    Parameters
    ----------
    backend
        The solver.
    data
        The problem.
    limits, seed, start
        As the back ends say.
    whole
        Whether the solver wants whole columns only.

    Returns
    -------
    Where bundles and pods go. The bound is at least that of the relaxation.

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    begin = perf_counter()
    if start is not None:
        broken = violations(data, start)
        require(not broken, "start", "; ".join(broken))
    columns = Columns.of(data)
    linear = program(data, columns, whole=whole)
    point = None if start is None else columns_of(data, columns, start)
    built_s = perf_counter() - begin
    outcome = backend(linear, limits, seed=seed, start=point)
    if outcome.status in (Status.FEASIBLE, Status.LIMIT):
        outcome = _with_better_bound(outcome, linear)
    return outcome.solution(
        lambda x: stocking_of(data, columns, x),
        lambda stocking: objective(data, stocking),
        build_s=built_s,
    )


def _with_better_bound(outcome: Outcome, linear: LinearProgram) -> Outcome:
    """Give a search that its limit ended the bound of the relaxation, if that is better.

    The simplex iterations of the relaxation are not counted as work of the search.
    """
    relaxed = relax(linear)
    return dataclasses.replace(
        outcome,
        bound=max(outcome.bound, relaxed.bound),
        wall_s=outcome.wall_s + relaxed.wall_s,
    )
