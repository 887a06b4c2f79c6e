"""Back end for integer programs: the solver CP-SAT, limited by deterministic time.

One worker, a fixed seed and a limit in deterministic seconds (the solver's own measure of its work)
make results repeatable, whatever the load of the machine. The model is written directly into the
solver's protocol buffer, row by row from the compressed matrix, in a few microseconds per row.

CP-SAT needs integer costs. Fractional costs are therefore rounded *down* to multiples of a unit.
The unit is 1/1024; if every cost is below 1, it is 1/1024 of the largest cost, rounded to a power
of two so that scaling is exact. As all columns are non-negative, the minimum with rounded costs
never exceeds the true minimum, so the solver's bound remains valid. CP-SAT reports bounds as
floats, which are inexact above 2^53; there, the bound is lowered accordingly.
"""

from __future__ import annotations

import math
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray
from ortools.sat.python import cp_model
from ortools.sat.python.cp_model_helper import CpSolverStatus

from rmfs.solvers.models.backends.outcome import Outcome, trivial
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.program import LinearProgram
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Status, WallGuardError

NAME = "cp_sat"
RESOLUTION = 1024
"""Costs are rounded down to multiples of 1 / `RESOLUTION`, or finer if all costs are below 1."""

_FINEST_BITS = 1000
_FAR = 2**62
_EXACT = 2**53
"""Largest number up to which all whole numbers are floats."""


def solve(
    program: LinearProgram,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.float64] | None = None,
    presolve: bool = True,
) -> Outcome:
    """Solve a program with CP-SAT.

    Parameters
    ----------
    program
        The program. All columns must be integer and non-negative. All coefficients and all finite
        bounds of columns and rows must be whole numbers. Costs may be fractional.
    limits
        ``deterministic_s`` limits the search, which also ends at the relative gap ``gap``.
        Default: none, so that the search ends with a proven optimum.
    seed
        Seed of the solver. Default 0.
    start
        A feasible point to start from, one value per column. Default: none.
    presolve
        Whether the solver simplifies the program first. Under a short limit, a program with a tight
        relaxation is better solved without presolve. Default: yes.

    Returns
    -------
    The outcome.

    Raises
    ------
    ModelError
        If the program is not as described above, or a number is too large for the solver.
    WallGuardError
        If the solver was stopped by `limits.wall_guard_s`.
    """
    began = time.perf_counter()
    if (answer := trivial(program, NAME)) is not None:
        return answer
    scale = _scale(program.cost)
    model = _model(program, scale, start)
    solver = cp_model.CpSolver()
    configure(solver, limits, seed)
    solver.parameters.cp_model_presolve = presolve
    built = time.perf_counter()
    status = run(solver, model)
    require(
        status != cp_model.MODEL_INVALID,
        "program",
        f"CP-SAT rejects the program: {model.validate()}",
    )
    check_guard(solver, status, limits)
    return _outcome(program, solver, status, scale, began, built)


def configure(solver: cp_model.CpSolver, limits: Limits, seed: int) -> None:
    """Configure a solver: one worker, the given seed and the given limits.

    Parameters
    ----------
    solver
        The solver to configure.
    limits
        Deterministic time, gap and wall-clock guard.
    seed
        Seed of the search.
    """
    parameters = solver.parameters
    parameters.num_workers = 1
    # its own handler would replace that of Python, during the search and after it
    parameters.catch_sigint_signal = False
    parameters.random_seed = seed
    parameters.relative_gap_limit = limits.gap
    if limits.deterministic_s is not None:
        parameters.max_deterministic_time = limits.deterministic_s
    if limits.wall_guard_s is not None:
        parameters.max_time_in_seconds = limits.wall_guard_s


def run(solver: cp_model.CpSolver, model: cp_model.CpModel) -> CpSolverStatus:
    """Solve a model; Ctrl-C ends the search.

    Python handles signals only in the main thread, and not while the main thread is inside the
    solver. If called from the main thread, this function therefore searches in another thread.

    Parameters
    ----------
    solver
        A solver configured by `configure`.
    model
        The model to solve.

    Raises
    ------
    KeyboardInterrupt
        If the user interrupts the search; raised after the search has stopped.
    """
    if threading.current_thread() is not threading.main_thread():
        return solver.solve(model)
    with ThreadPoolExecutor(1) as pool:
        search = pool.submit(solver.solve, model)
        try:
            return search.result()
        except BaseException:
            solver.stop_search()
            raise


def check_guard(solver: cp_model.CpSolver, status: CpSolverStatus, limits: Limits) -> None:
    """Raise an error if the wall-clock guard, not a deterministic limit, ended the search.

    Parameters
    ----------
    solver
        The solver after its run.
    status
        Status that the run returned.
    limits
        Limits of the run.

    Raises
    ------
    WallGuardError
        If the wall-clock guard ended the search.
    """
    if limits.wall_guard_s is None or status in (cp_model.OPTIMAL, cp_model.INFEASIBLE):
        return
    worked_off = limits.deterministic_s is not None and (
        solver.deterministic_time >= limits.deterministic_s * (1.0 - 1e-6)
    )
    if not worked_off:
        raise WallGuardError(f"CP-SAT was stopped after {solver.wall_time:.1f} s")


def _scale(cost: NDArray[np.float64]) -> float:
    """Return the power of two by which costs are multiplied before they are rounded."""
    if bool(np.all(cost == np.rint(cost))):
        return 1.0
    # the largest is in [2^(exponent - 1), 2^exponent)
    _, exponent = math.frexp(float(np.abs(cost).max()))
    return math.ldexp(RESOLUTION, min(max(0, 1 - exponent), _FINEST_BITS))


def _model(
    program: LinearProgram, scale: float, start: NDArray[np.float64] | None
) -> cp_model.CpModel:
    """Write columns, rows, costs and start into the solver's protocol structure."""
    require(
        bool(program.integer.all()),
        "integer",
        "must be true for all columns, as CP-SAT needs integer columns",
    )
    require(bool(np.all(program.lower >= 0)), "lower", "CP-SAT needs non-negative columns")
    model = cp_model.CpModel()
    proto = model.proto
    lower, upper = _whole("lower", program.lower), _whole("upper", program.upper)
    for domain in zip(lower, upper, strict=True):
        proto.variables.add().domain.extend(domain)
    coefficient, column = _whole("coefficient", program.coefficient), program.column.tolist()
    row_lower, row_upper = (
        _whole("row_lower", program.row_lower),
        _whole("row_upper", program.row_upper),
    )
    begin = 0
    for row, end in enumerate(program.row_start[1:].tolist()):
        linear = proto.constraints.add().linear
        linear.vars.extend(column[begin:end])
        linear.coeffs.extend(coefficient[begin:end])
        linear.domain.extend((row_lower[row], row_upper[row]))
        begin = end
    cost = np.floor(program.cost * scale)
    total = _largest_sum(program, scale)
    require(total <= _FAR, "cost", f"adds up to {total:.1e}; CP-SAT counts to {_FAR:.1e} at most")
    paid = np.flatnonzero(cost)
    proto.objective.vars.extend(paid.tolist())
    proto.objective.coeffs.extend(_whole("cost", cost[paid]))
    # the gap is relative to the whole objective
    proto.objective.offset = program.offset * scale
    if start is not None:
        proto.solution_hint.vars.extend(range(program.columns))
        proto.solution_hint.values.extend(_whole("start", np.rint(start)))
    return model


def _largest_sum(program: LinearProgram, scale: float) -> float:
    """Return an upper bound on the absolute value of every sum of the solver's costs."""
    return float(np.abs(np.floor(program.cost * scale)) @ np.maximum(program.upper, 1.0))


def _whole(field: str, values: NDArray[np.float64]) -> list[int]:
    """Return an array of floats as whole numbers; infinite values become the solver's limits."""
    finite = np.where(np.isfinite(values), values, np.sign(values) * _FAR)
    require(bool(np.all(np.abs(finite) <= _FAR)), field, f"CP-SAT counts to {_FAR:.1e} at most")
    require(bool(np.all(finite == np.rint(finite))), field, "CP-SAT needs whole numbers")
    whole: list[int] = finite.astype(np.int64).tolist()
    return whole


def _outcome(
    program: LinearProgram,
    solver: cp_model.CpSolver,
    status: CpSolverStatus,
    scale: float,
    began: float,
    built: float,
) -> Outcome:
    """Return the outcome of the run."""
    statuses = {
        cp_model.OPTIMAL: Status.OPTIMAL,
        cp_model.FEASIBLE: Status.FEASIBLE,
        cp_model.INFEASIBLE: Status.INFEASIBLE,
        cp_model.UNKNOWN: Status.LIMIT,
    }
    if status not in statuses:
        raise RuntimeError(f"CP-SAT ended with {status}: a malformed model")
    ended = statuses[status]
    x = None
    bound = -math.inf
    if ended in (Status.OPTIMAL, Status.FEASIBLE):
        x = np.array(solver.response_proto.solution, dtype=np.float64)
        bound = solver.best_objective_bound
        if (total := _largest_sum(program, scale)) > _EXACT:
            bound -= 4.0 * total / _EXACT
        bound /= scale
    elif ended is Status.INFEASIBLE:
        bound = math.inf
    return Outcome(
        x=x,
        bound=bound,
        status=ended,
        backend=NAME,
        work=float(solver.deterministic_time),
        build_s=built - began,
        wall_s=time.perf_counter() - began,
        built=float(program.nonzeros),
    )
