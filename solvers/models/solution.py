"""The result and the limits of a solve, in the form that all models use.

A solve is limited in deterministic work, not in time, so the same input gives the same output
however busy the machine is. There is also a wall-clock guard, but it can only raise an error.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from time import perf_counter
from typing import Generic, TypeVar

from rmfs.solvers.models.checks import integers, number, require

V = TypeVar("V")
V_co = TypeVar("V_co", covariant=True)

GAP_FLOOR = 1e-9
"""Smallest denominator of a relative gap, so that an optimum of 0 has gap 0."""

BOUND_TOLERANCE = 1e-6
"""Relative amount by which a bound may exceed the objective before it counts as a defect."""


class WallGuardError(RuntimeError):
    """A solve took longer than its wall-clock guard allows.

    No result is returned, because it would not be reproducible.
    """


class Status(Enum):
    """The outcome of a solve."""

    OPTIMAL = "optimal"
    """Values proven to be within the gap limit of the optimum. CP-SAT proves this for costs rounded
    down to at least 1/1024 (`rmfs.solvers.models.backends.cp_sat`); the solution's gap is that with
    the exact costs."""

    FEASIBLE = "feasible"
    """Values that satisfy every constraint, from a heuristic or a search ended by its limit."""

    INFEASIBLE = "infeasible"
    """The constraints are proven to be unsatisfiable."""

    LIMIT = "limit"
    """No feasible solution was found, as a limit was reached or a heuristic failed."""


class Sense(Enum):
    """Whether the objective is minimised or maximised."""

    MINIMISE = 1
    MAXIMISE = -1

    @property
    def worst(self) -> float:
        """Value of the objective if there is no solution: +inf if minimised, -inf if maximised."""
        return math.inf * self.value


@dataclass(frozen=True)
class Limits:
    """Limits of a solve.

    Parameters
    ----------
    deterministic_s
        Limit on the work of CP-SAT or of column generation, in deterministic seconds. A
        deterministic second is a fixed amount of counted work, which takes one core roughly a
        second. Default: none.
    nodes
        Maximum number of branch-and-bound nodes of HiGHS. Default: none.
    iterations
        Maximum number of iterations of the simplex method (for LPs only), of an interior-point
        method, or of a heuristic or search that works in steps. Default: that of the method.
    gap
        Maximum relative gap of a solution that counts as optimal. Default 0.
    wall_guard_s
        Wall-clock seconds after which the solve raises `WallGuardError`. This guard never changes a
        result. Default: none.

    Raises
    ------
    ModelError
        If a limit is negative or not a number, or `nodes` or `iterations` is not a whole number.
    """

    deterministic_s: float | None = None
    nodes: int | None = None
    iterations: int | None = None
    gap: float = 0.0
    wall_guard_s: float | None = None

    def __post_init__(self) -> None:
        for field in ("deterministic_s", "gap", "wall_guard_s"):
            value = getattr(self, field)
            if value is not None:
                number(f"limits.{field}", value, low=0)
        for field in ("nodes", "iterations"):
            value = getattr(self, field)
            if value is not None:
                whole = int(integers(f"limits.{field}", value, (), low=0))
                object.__setattr__(self, field, whole)


NO_LIMITS = Limits()
"""Solve to proven optimality."""


@dataclass(frozen=True)
class Solution(Generic[V_co]):
    """The result of one solve.

    Parameters
    ----------
    values
        The decision; None if `status` is INFEASIBLE or LIMIT.
    objective
        Objective value, computed by the model's own objective function, not reported by a solver;
        `sense.worst` if there are no values.
    bound
        A proven bound on the optimal objective value: a lower bound if the objective is minimised,
        an upper bound if it is maximised; ``-sense.worst`` if no bound is known.
    status
        The outcome of the solve.
    backend
        Name of the back end, such as ``"cp_sat"``, ``"highs"``, ``"rule"``.
    wall_s
        Wall-clock seconds of the whole call, including `build_s`; not reproducible.
    build_s
        The part of `wall_s` spent building the solver's model from the arrays.
    work
        Deterministic work spent, in the back end's unit (`WORK_UNITS`).
    sense
        Whether the objective is minimised or maximised. Default: minimised.
    built
        Deterministic work spent building models, counted in nonzeros. For programs passed to a
        solver, this is the number of nonzeros; for other models, the number of nonzeros that would
        take as long to build.

    Raises
    ------
    ModelError
        If the attributes contradict each other, for example if the bound is beyond the objective.
    """

    values: V_co | None
    objective: float
    bound: float
    status: Status
    backend: str
    wall_s: float = 0.0
    build_s: float = 0.0
    work: float = 0.0
    sense: Sense = Sense.MINIMISE
    built: float = 0.0

    def __post_init__(self) -> None:
        found = self.status in (Status.OPTIMAL, Status.FEASIBLE)
        require(found == (self.values is not None), "values", f"do not fit status {self.status}")
        require(not math.isnan(self.objective), "objective", "is not a number")
        require(not math.isnan(self.bound), "bound", "is not a number")
        if found:
            require(math.isfinite(self.objective), "objective", "must be finite")
            excess = (self.bound - self.objective) * self.sense.value
            slack = BOUND_TOLERANCE * max(1.0, abs(self.objective))
            require(excess <= slack, "bound", f"{self.bound} is beyond {self.objective}")

    @property
    def found(self) -> bool:
        """Whether there is a solution."""
        return self.values is not None

    @property
    def gap(self) -> float:
        """Relative gap between objective and bound, ``|objective - bound| / |objective|``.

        The gap is inf if there is no solution or no bound. It is 0 if rounding puts the bound
        beyond the objective, or if both are 0 up to `BOUND_TOLERANCE`.
        """
        if not self.found or math.isinf(self.bound):
            return math.inf
        if max(abs(self.objective), abs(self.bound)) <= BOUND_TOLERANCE:
            return 0.0
        distance = max(0.0, (self.objective - self.bound) * self.sense.value)
        return distance / max(abs(self.objective), GAP_FLOOR)

    @property
    def solve_s(self) -> float:
        """Wall-clock seconds of the call without those spent building the solver's model."""
        return self.wall_s - self.build_s

    @property
    def required(self) -> V_co:
        """The values, never None.

        Raises
        ------
        ValueError
            If there are no values.
        """
        if self.values is None:
            raise ValueError(f"no values: {self.backend} ended with {self.status.value}")
        return self.values

    def summary(self) -> str:
        """Return one readable line: back end, outcome, objective, bound, gap, work and time."""
        return (
            f"{self.backend}: {self.status.value}, objective {self.objective:g}, "
            f"bound {self.bound:g}, gap {self.gap:.2%}, work {self.work:g}, "
            f"{self.wall_s * 1e3:.1f} ms ({self.build_s * 1e3:.1f} ms building)"
        )


def solution_of_rule(
    values: V | None,
    objective: Callable[[V], float],
    *,
    bound: float,
    work: float,
    began: float,
    built: float = 0.0,
) -> Solution[V]:
    """Create the `Solution` of a heuristic for a minimisation problem.

    Parameters
    ----------
    values
        The heuristic's solution; None if it found no feasible solution.
    objective
        The model's objective function.
    bound
        A proven lower bound; +inf if the problem is proven infeasible.
    work
        Number of candidates scored.
    began
        Time when the call began, by `time.perf_counter`.
    built
        As for `Solution`. Default 0.
    """
    wall_s = perf_counter() - began
    if values is None:
        status = Status.LIMIT if bound < math.inf else Status.INFEASIBLE
        return Solution(None, math.inf, bound, status, "rule", wall_s, 0.0, work, built=built)
    value = objective(values)
    bound = min(bound, value)
    status = Status.FEASIBLE
    return Solution(values, value, bound, status, "rule", wall_s, 0.0, work, built=built)


def solution_of_optimum(
    values: V | None,
    objective: Callable[[V], float],
    *,
    bound: float,
    backend: str,
    work: float,
    began: float,
    built: float,
) -> Solution[V]:
    """Create the `Solution` of an exact method for a minimisation problem.

    The status is FEASIBLE if the bound shows that the method had to round the costs too coarsely to
    prove the values optimal.

    Parameters
    ----------
    values
        Optimal values, up to rounding; None if the problem is infeasible.
    objective
        The model's objective function.
    bound
        Proven lower bound.
    backend
        Name of the back end.
    work
        Work in the back end's unit.
    began, built
        Times when the call began and when the solver's model was complete, by `time.perf_counter`.
    """
    wall_s, build_s = perf_counter() - began, built - began
    if values is None:
        status = Status.INFEASIBLE
        return Solution(None, math.inf, math.inf, status, backend, wall_s, build_s, work)
    value = objective(values)
    bound = min(bound, value)
    proven = value - bound <= BOUND_TOLERANCE * max(1.0, abs(value))
    status = Status.OPTIMAL if proven else Status.FEASIBLE
    return Solution(values, value, bound, status, backend, wall_s, build_s, work)


WORK_UNITS = {
    "cp_sat": "deterministic seconds",
    "highs": "simplex iterations over all nodes",
    "clarabel": "interior-point iterations",
    "columns": "deterministic seconds",
    "rule": "candidates scored",
    "scipy": "entries of the cost table",
    "min_cost_flow": "arcs",
    "rounding": "simplex iterations",
    "dynamic": "states expanded",
    "visits": "stock entries and lines examined",
    "insertions": "positions examined for tasks",
}
"""The unit of `Solution.work` per back end; the entry of heuristics is "rule"."""
