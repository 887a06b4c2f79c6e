"""Rounding of the linear relaxation: its solution suggests which pods to bring for which bundles.

The relaxation is tight and is solved much faster than the integer program. Pods and bundles with
large values in its solution are chosen first, as in fix-and-dive heuristics. The greedy rule then
brings further pods. The value of the relaxation is a bound.
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.backend import relax
from rmfs.solvers.models.replenishment.data import Replenishment, Stocking, objective, violations
from rmfs.solvers.models.replenishment.greedy import Filling
from rmfs.solvers.models.replenishment.polish import polished
from rmfs.solvers.models.replenishment.program import Columns, program
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status

_SOME = 1e-6
"""Column values up to this are treated as zero."""


def solve(
    data: Replenishment,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Stocking | None = None,
) -> Solution[Stocking]:
    """Bring the pods with the largest values in the relaxation, and then pods by the greedy rule.

    Parameters
    ----------
    data
        The problem.
    limits
        `iterations` limits the simplex iterations for the relaxation. If this limit is reached, the
        greedy rule decides alone, and the bound is weak. `gap` is the relative gap up to which the
        status is OPTIMAL.
    seed
        Seed of the solver. Default 0.
    start
        Not used.

    Returns
    -------
    The pod of each bundle and the station of each pod; ties go to the lowest index. The status is
    LIMIT if a bundle that must be stored is left, and INFEASIBLE if the relaxation is infeasible.
    Work is counted in simplex iterations.
    """
    begin = perf_counter()
    columns = Columns.of(data)
    linear = program(data, columns, whole=False)
    built_s = perf_counter() - begin
    outcome = relax(linear, limits, seed=seed)
    build_s = built_s + outcome.build_s
    if outcome.status is Status.INFEASIBLE:
        wall_s = perf_counter() - begin
        return Solution(
            None, math.inf, math.inf, outcome.status, "rounding", wall_s, build_s, outcome.work
        )
    filling = Filling(data)
    if outcome.x is not None:
        _follow(filling, columns, outcome.x)
    stocking = polished(data, filling.run())
    wall_s = perf_counter() - begin
    if violations(data, stocking):
        return Solution(
            None, math.inf, outcome.bound, Status.LIMIT, "rounding", wall_s, build_s, outcome.work
        )
    value = objective(data, stocking)
    bound = min(outcome.bound, value)
    close = value - bound <= limits.gap * abs(value)
    status = Status.OPTIMAL if close else Status.FEASIBLE
    return Solution(stocking, value, bound, status, "rounding", wall_s, build_s, outcome.work)


def _follow(filling: Filling, columns: Columns, x: NDArray[np.float64]) -> None:
    """Bring pods in decreasing order of their values in the relaxation, if they have a gain."""
    pairs, options = len(columns.bundle), len(columns.brought)
    put, brought = x[:pairs], x[pairs : pairs + options]
    wanted: dict[int, list[int]] = {}
    for pair in np.argsort(-put, kind="stable").tolist():
        if put[pair] <= _SOME:
            break
        wanted.setdefault(int(columns.pod[pair]), []).append(int(columns.bundle[pair]))
    for option in np.argsort(-brought, kind="stable").tolist():
        if brought[option] <= _SOME:
            break
        pod, station = int(columns.brought[option]), int(columns.station[option])
        if pod not in wanted:
            continue
        gain, bundles = filling.gain(pod, station, wanted[pod])
        if gain > 0:
            filling.bring(pod, station, bundles)
            del wanted[pod]
