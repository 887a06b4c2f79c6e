"""The proven bound, computed by HiGHS and repaired so that no solver error can make it too low."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from rmfs.solvers.models.backends.safe_bound import safe_bound
from rmfs.solvers.models.run_bound.data import RunBound, Throughput, objective
from rmfs.solvers.models.run_bound.program import Columns, program
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Sense, Solution, Status

_ENDLESS = 2**31 - 1


def solve(
    data: RunBound,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Throughput | None = None,
) -> Solution[Throughput]:
    """Return an upper bound on the units per hour of any run, and the linear program's optimum.

    Parameters
    ----------
    data
        The warehouse.
    limits
        `iterations` limits the simplex method; the bound is valid even if this limit is reached.
    seed, start
        Not used, as this is a linear program.

    Returns
    -------
    The counts at the optimum (None if the limit was reached) and, as `bound`, the proven bound in
    units per hour. Work is counted in simplex iterations.
    """
    begin = perf_counter()
    linear, columns = program(data)
    built = perf_counter()
    result = linprog(
        linear.cost,
        A_ub=linear.matrix.toarray(),
        b_ub=linear.row_upper,
        bounds=list(zip(linear.lower.tolist(), linear.upper.tolist(), strict=True)),
        method="highs",
        options={"maxiter": _ENDLESS if limits.iterations is None else limits.iterations},
    )
    multipliers = np.zeros(linear.rows)
    if result.success:
        multipliers = np.asarray(result.ineqlin.marginals)
    bound = float(np.nextafter(-safe_bound(linear, multipliers) / data.hours, math.inf))
    values = _values(np.asarray(result.x), columns) if result.success else None
    return Solution(
        values,
        -math.inf if values is None else objective(data, values),
        bound,
        Status.LIMIT if values is None else Status.OPTIMAL,
        "highs",
        perf_counter() - begin,
        built - begin,
        float(result.nit),
        Sense.MAXIMISE,
    )


def _values(x: NDArray[np.float64], columns: Columns) -> Throughput:
    return Throughput(
        units=x[columns.units],
        visits=x[columns.visits],
        lone_units=x[columns.lone_units],
        bundles=x[columns.bundles],
        refill_visits=x[columns.refill_visits],
    )
