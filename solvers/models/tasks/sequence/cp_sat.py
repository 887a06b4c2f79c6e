"""Routes by CP-SAT, with a limit in deterministic time."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from ortools.sat.python import cp_model

from rmfs.solvers.models.backends.cp_sat import check_guard, configure, run
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status
from rmfs.solvers.models.tasks.sequence.bound import relaxed_bound
from rmfs.solvers.models.tasks.sequence.candidates import Ways, every_way
from rmfs.solvers.models.tasks.sequence.circuit import Circuit
from rmfs.solvers.models.tasks.sequence.data import NONE, TICKS_PER_S, Routes, TaskSequence
from rmfs.solvers.models.tasks.sequence.schedule import objective, violations

ARC_ENTRIES = 14.0
"""Number of nonzeros of a program that take as long to build as one arc; it converts arcs to
`Solution.built`."""

_STATUS = {
    cp_model.OPTIMAL: Status.OPTIMAL,
    cp_model.FEASIBLE: Status.FEASIBLE,
    cp_model.INFEASIBLE: Status.INFEASIBLE,
    cp_model.UNKNOWN: Status.LIMIT,
}


def solve(
    data: TaskSequence,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Routes | None = None,
    ways: Ways | None = None,
) -> Solution[Routes]:
    """Find routes of least cost by CP-SAT.

    Parameters
    ----------
    data
        The problem.
    limits
        `deterministic_s` and `gap` apply. Default: none; the solver then runs to optimality.
    seed
        Seed of the solver. Default 0.
    start
        Feasible routes to start from. Default: none.
    ways
        Arcs to consider, such as those of `short_ways` if there are many tasks. Default: all.

    Returns
    -------
    The routes, never worse than the start. The bound holds for routes over all arcs of the problem,
    even if `ways` lacks some arcs. If all arcs were considered, the bound is the better of the
    solver's bound and that of `relaxed_bound`. If some were not, the bound is that of
    `relaxed_bound`; the status is OPTIMAL only if this bound proves the routes optimal, otherwise
    FEASIBLE, or LIMIT if no routes were found.

    Raises
    ------
    ModelError
        If the start is not feasible.
    WallGuardError
        If the solve took longer than the wall-clock guard allows.
    """
    begin = perf_counter()
    if start is not None:
        broken = violations(data, start)
        require(not broken, "start", "; ".join(broken))
    if not data.robots:
        return _without_robots(data, begin)
    looked_at = every_way(data) if ways is None else ways
    circuit = Circuit(data, looked_at)
    if start is not None:
        circuit.hint(start)
    solver = cp_model.CpSolver()
    configure(solver, limits, seed)
    built = perf_counter()
    ended = run(solver, circuit.model)
    check_guard(solver, ended, limits)
    status, work = _STATUS[ended], float(solver.deterministic_time)
    routes = circuit.read(solver) if status in (Status.OPTIMAL, Status.FEASIBLE) else None
    if routes is None and start is not None:
        # the limit came before the solver had even read the start
        routes, status = start, Status.FEASIBLE
    value = math.inf if routes is None else objective(data, routes)
    bound = relaxed_bound(data)
    if not looked_at.complete:
        status = _without_proof(status, value, bound, limits)
    elif status is Status.INFEASIBLE:
        bound = math.inf
    else:
        bound = max(bound, solver.best_objective_bound / TICKS_PER_S)
    if routes is None and math.isinf(bound):
        status = Status.INFEASIBLE
    wall_s, build_s = perf_counter() - begin, built - begin
    return Solution(
        routes,
        value,
        min(bound, value),
        status,
        "cp_sat",
        wall_s,
        build_s,
        work,
        built=ARC_ENTRIES * circuit.arcs,
    )


def _without_proof(status: Status, value: float, bound: float, limits: Limits) -> Status:
    """Return the status for all arcs after a search over some of them."""
    if status is Status.INFEASIBLE:
        return Status.LIMIT
    if status is Status.OPTIMAL and value - bound > limits.gap * abs(value):
        return Status.FEASIBLE
    return status


def _without_robots(data: TaskSequence, begin: float) -> Solution[Routes]:
    """Return the solution of a problem without robots: all tasks are postponed."""
    routes = Routes((), np.full(data.tasks, NONE, np.int64), np.zeros(0, np.int64))
    value = objective(data, routes)
    wall_s = perf_counter() - begin
    if math.isinf(value):
        return Solution(None, math.inf, math.inf, Status.INFEASIBLE, "cp_sat", wall_s)
    return Solution(routes, value, value, Status.OPTIMAL, "cp_sat", wall_s)
