"""Back end for linear and mixed-integer programs: the solver HiGHS, limited by nodes or iterations.

On one thread, HiGHS is deterministic. The limit of a mixed-integer program is a number of
branch-and-bound nodes; as the work per node varies, `Outcome.work` counts simplex iterations. The
bound that `solve` returns comes from floating-point LPs, so it is lowered by the relative tolerance
`NUMERICAL_TOLERANCE`. For a pure LP, `solve` returns the bound proven by the dual multipliers
(`safe_bound`) if that is still lower. If coefficients are huge, HiGHS may round integer columns
wrongly, so integer programs with coefficients above `LARGEST` are refused.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import highspy  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.outcome import NUMERICAL_TOLERANCE, Outcome, Relaxation, trivial
from rmfs.solvers.models.backends.safe_bound import safe_bound
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.program import LinearProgram
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Status, WallGuardError

NAME = "highs"
LARGEST = 1e9
"""Largest coefficient of an integer program, in absolute value."""

_INTEGER_LIMIT = 2**31 - 1


def solve(
    program: LinearProgram,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: NDArray[np.float64] | None = None,
) -> Outcome:
    """Solve a program with HiGHS.

    Parameters
    ----------
    program
        The linear or mixed-integer program.
    limits
        ``nodes`` limits branch and bound, which also ends at the relative gap ``gap``;
        ``iterations`` limits the simplex method on a pure LP. Default: none, so that the solver
        ends with a proven optimum.
    seed
        Random seed of the solver. Default 0.
    start
        A feasible point to start from, one value per column. Default: none.

    Returns
    -------
    The outcome; integer columns are rounded to exact integers.

    Raises
    ------
    ModelError
        If the program has integer columns and a coefficient above `LARGEST`.
    WallGuardError
        If the solver was stopped by `limits.wall_guard_s`.
    """
    began = time.perf_counter()
    if (answer := trivial(program, NAME)) is not None:
        return answer
    if program.integer.any():
        largest = float(np.abs(program.coefficient).max(initial=0.0))
        require(
            largest <= LARGEST,
            "coefficient",
            f"is {largest:.1e}; HiGHS solves integer programs reliably up to {LARGEST:.0e}: "
            "choose a larger unit",
        )
    solver = highspy.Highs()
    _set_options(solver, limits, seed)
    solver.passModel(_lp(program))
    if start is not None:
        solution = highspy.HighsSolution()
        solution.col_value = start.tolist()
        solver.setSolution(solution)
    built = time.perf_counter()
    solver.run()
    return _outcome(program, solver, began, built)


def relax(
    program: LinearProgram, limits: Limits = NO_LIMITS, *, interior: bool = False
) -> Relaxation:
    """Solve the linear relaxation.

    Parameters
    ----------
    program
        The program; integrality is ignored.
    limits
        ``iterations`` limits the simplex method. Default: none.
    interior
        Whether to use the interior-point method instead of the simplex method. With 10,000 columns
        or more, the interior-point method takes a fraction of the time. Default: no.

    Returns
    -------
    The solution of the relaxation, with a bound that is valid despite rounding (`safe_bound`).

    Raises
    ------
    WallGuardError
        If the solver was stopped by `limits.wall_guard_s`.
    """
    began = time.perf_counter()
    relaxed = replace(program, integer=np.zeros(program.columns, dtype=np.bool_))
    solver = highspy.Highs()
    _set_options(solver, limits, seed=0)
    if interior:
        solver.setOptionValue("solver", "ipm")
        solver.setOptionValue("run_crossover", "off")
    solver.passModel(_lp(relaxed))
    built = time.perf_counter()
    solver.run()
    outcome = _outcome(relaxed, solver, began, built)
    multipliers = _multipliers(program, solver)
    return Relaxation(
        x=outcome.x,
        multipliers=multipliers,
        bound=safe_bound(program, multipliers),
        work=outcome.work,
        build_s=built - began,
        wall_s=time.perf_counter() - began,
    )


def _set_options(solver: highspy.Highs, limits: Limits, seed: int) -> None:
    """One thread, a fixed seed, silence, and the limits."""
    options: dict[str, str | int | float | bool] = {
        "output_flag": False,
        "threads": 1,
        "parallel": "off",
        "random_seed": seed,
        "mip_rel_gap": limits.gap,
        "mip_abs_gap": 0.0 if limits.gap == 0.0 else 1e-6,
    }
    if limits.nodes is not None:
        options["mip_max_nodes"] = min(limits.nodes, _INTEGER_LIMIT)
    if limits.iterations is not None:
        options["simplex_iteration_limit"] = min(limits.iterations, _INTEGER_LIMIT)
    if limits.wall_guard_s is not None:
        options["time_limit"] = limits.wall_guard_s
    for name, value in options.items():
        if solver.setOptionValue(name, value) != highspy.HighsStatus.kOk:
            raise RuntimeError(f"HiGHS refuses {name} = {value!r}")


def _lp(program: LinearProgram) -> highspy.HighsLp:
    """The program in the solver's own structure, array by array."""
    lp = highspy.HighsLp()
    lp.num_col_ = program.columns
    lp.num_row_ = program.rows
    lp.offset_ = program.offset
    lp.col_cost_ = program.cost
    lp.col_lower_ = program.lower
    lp.col_upper_ = program.upper
    lp.row_lower_ = program.row_lower
    lp.row_upper_ = program.row_upper
    if program.integer.any():
        kinds = (highspy.HighsVarType.kContinuous, highspy.HighsVarType.kInteger)
        lp.integrality_ = [kinds[whole] for whole in program.integer.tolist()]
    matrix = lp.a_matrix_
    matrix.format_ = highspy.MatrixFormat.kRowwise
    matrix.num_col_ = program.columns
    matrix.num_row_ = program.rows
    matrix.start_ = program.row_start
    matrix.index_ = program.column
    matrix.value_ = program.coefficient
    return lp


def _outcome(program: LinearProgram, solver: highspy.Highs, began: float, built: float) -> Outcome:
    """Return the outcome of the run."""
    model_status, info = solver.getModelStatus(), solver.getInfo()
    if model_status == highspy.HighsModelStatus.kTimeLimit:
        raise WallGuardError(f"HiGHS was stopped after {time.perf_counter() - built:.1f} s")
    infeasible = model_status in (
        highspy.HighsModelStatus.kInfeasible,
        # All columns are bounded, so "unbounded or infeasible" can only be infeasible.
        highspy.HighsModelStatus.kUnboundedOrInfeasible,
    )
    found = info.primal_solution_status == highspy.SolutionStatus.kSolutionStatusFeasible
    optimal = model_status == highspy.HighsModelStatus.kOptimal
    x = None
    if found and not infeasible:
        x = np.array(solver.getSolution().col_value)
        x[program.integer] = np.rint(x[program.integer])
        x = np.clip(x, program.lower, program.upper)
    if infeasible:
        status, bound = Status.INFEASIBLE, math.inf
    elif x is None:
        status, bound = Status.LIMIT, _bound(program, solver)
    else:
        status = Status.OPTIMAL if optimal else Status.FEASIBLE
        bound = _bound(program, solver)
    return Outcome(
        x=x,
        bound=bound,
        status=status,
        backend=NAME,
        work=float(max(info.simplex_iteration_count, 0)),
        build_s=built - began,
        wall_s=time.perf_counter() - began,
        built=float(program.nonzeros),
    )


def _multipliers(program: LinearProgram, solver: highspy.Highs) -> NDArray[np.float64]:
    """Return the dual value of each row; zeros if the solver has none."""
    solution = solver.getSolution()
    if not solution.dual_valid:
        return np.zeros(program.rows)
    return np.array(solution.row_dual, dtype=np.float64)


def _bound(program: LinearProgram, solver: highspy.Highs) -> float:
    """The solver's lower bound, lowered by its tolerance."""
    info = solver.getInfo()
    if program.integer.any():
        raw = float(info.mip_dual_bound)
        return _lowered(raw) if math.isfinite(raw) else -math.inf
    if solver.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return -math.inf
    # small errors of reduced costs add up over columns with large ranges
    proven = safe_bound(program, _multipliers(program, solver))
    return min(_lowered(float(info.objective_function_value)), proven)


def _lowered(bound: float) -> float:
    return bound - NUMERICAL_TOLERANCE * max(1.0, abs(bound))
