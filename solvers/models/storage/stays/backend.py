"""What the back ends have in common: state the programme, hand it over, read the answer."""

from __future__ import annotations

from time import perf_counter
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from solvers.models.backends import Outcome
from solvers.models.checks import require
from solvers.models.program import LinearProgram
from solvers.models.solution import Limits, Solution
from solvers.models.storage.stays.data import Stays, objective, violations
from solvers.models.storage.stays.program import columns_of, program, zones_of


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
    data: Stays,
    limits: Limits,
    seed: int,
    start: NDArray[np.int64] | None,
    *,
    whole: bool,
) -> Solution[NDArray[np.int64]]:
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
    The zone of each stay, shape (S,).

    Raises
    ------
    ModelError
        If the start is not feasible.
    """
    begin = perf_counter()
    if start is not None:
        broken = violations(data, start)
        require(not broken, "start", "; ".join(broken))
    linear = program(data, whole=whole)
    columns = None if start is None else columns_of(data, start)
    built_s = perf_counter() - begin
    outcome = backend(linear, limits, seed=seed, start=columns)
    return outcome.solution(
        lambda x: zones_of(data, x), lambda zone: objective(data, zone), build_s=built_s
    )
