"""The optimal steady state, solved by the interior-point method Clarabel through cvxpy.

For each problem size (number of classes and number of zones), cvxpy compiles the problem into a
cone program once. All values in `Zones` are parameters of that program (disciplined parametrised
programming), so solving again with other values skips the compilation. There is no warm start, so
the result of a solve depends only on its input.
"""

from __future__ import annotations

import math
import warnings
from functools import lru_cache
from time import perf_counter

import cvxpy as cp
import numpy as np
from cvxpy.atoms.affine.binary_operators import multiply
from cvxpy.atoms.affine.sum import sum as total
from cvxpy.atoms.sum_squares import sum_squares
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, Status, WallGuardError
from rmfs.solvers.models.storage.zones.data import ZonePlan, Zones, objective
from rmfs.solvers.models.storage.zones.prices import price_bound
from rmfs.solvers.models.storage.zones.repair import repaired

EXACT = 1e-6
"""Gap at which an interior-point solution counts as optimal, relative to the objective or, if the
objective is below 1 s/h, in s/h."""

_SIZES_KEPT = 8


def solve(
    data: Zones, limits: Limits = NO_LIMITS, *, seed: int = 0, start: ZonePlan | None = None
) -> Solution[ZonePlan]:
    """Find the steady state with the least robot time, and the prices of places.

    Parameters
    ----------
    data
        The problem.
    limits
        `iterations` limits the interior-point method. Even if the limit ends the solve, the plan is
        feasible and the bound is valid.
    seed, start
        Not used.

    Returns
    -------
    The plan, made exactly feasible, with its prices. Work is the number of iterations. The status
    is OPTIMAL if the gap is at most `EXACT` or at most the gap limit, otherwise FEASIBLE; it is
    INFEASIBLE if there are fewer places than pods.

    Raises
    ------
    WallGuardError
        If the solve took longer than the wall-clock guard allows.
    """
    begin = perf_counter()
    if not data.fits:
        wall_s = perf_counter() - begin
        return Solution(None, math.inf, math.inf, Status.INFEASIBLE, "clarabel", wall_s)
    if not data.pods.sum():
        plan = ZonePlan(np.zeros(data.visit_s.shape), np.zeros(len(data.places)))
        wall_s = perf_counter() - begin
        return Solution(plan, 0.0, 0.0, Status.OPTIMAL, "clarabel", wall_s)
    programme = _compiled(*data.visit_s.shape)
    programme.set(data)
    built = perf_counter()
    standing, price_per_h, iterations = programme.run(limits)
    elapsed_s = perf_counter() - built
    if limits.wall_guard_s is not None and elapsed_s > limits.wall_guard_s:
        raise WallGuardError(f"Clarabel took {elapsed_s:.1f} s")
    plan = ZonePlan(repaired(data, standing), np.maximum(price_per_h, 0.0))
    value = objective(data, plan)
    bound = min(price_bound(data, plan), value)
    close = value - bound <= max(limits.gap * value, EXACT * max(value, 1.0))
    return Solution(
        plan,
        value,
        bound,
        Status.OPTIMAL if close else Status.FEASIBLE,
        "clarabel",
        perf_counter() - begin,
        built - begin,
        float(iterations),
    )


class _Programme:
    """The compiled program for one problem size.

    The traffic is a separate variable, so that no product of two parameters occurs.

    Parameters
    ----------
    classes, zones
        Number of classes and number of zones.
    """

    def __init__(self, classes: int, zones: int) -> None:
        self._standing = cp.Variable((classes, zones), nonneg=True)
        traffic = cp.Variable(zones)
        self._driving = cp.Parameter((classes, zones), nonneg=True)
        self._rate = cp.Parameter(classes, nonneg=True)
        self._bend = cp.Parameter(zones, nonneg=True)
        self._pods = cp.Parameter(classes, nonneg=True)
        self._places = cp.Parameter(zones, nonneg=True)
        self._fit = total(self._standing, axis=0) <= self._places
        driving = total(multiply(self._driving, self._standing))
        waiting = sum_squares(multiply(self._bend, traffic))
        self._problem = cp.Problem(
            cp.Minimize(driving + waiting),
            [
                total(self._standing, axis=1) == self._pods,
                traffic == self._rate @ self._standing,
                self._fit,
            ],
        )
        self._scale = 1.0
        # the first solve of a problem compiles it; do so with numbers that mean nothing
        self.set(
            Zones(
                visit_s=np.ones((classes, zones)),
                rate_per_h=np.ones(classes),
                pods=np.ones(classes),
                places=np.full(zones, float(classes)),
                congestion_s_h=np.ones(zones),
            )
        )
        self._problem.get_problem_data(cp.CLARABEL, enforce_dpp=True)

    def set(self, data: Zones) -> None:
        """Fill in the numbers, scaled to a cost of about 1 per pod.

        Parameters
        ----------
        data
            A problem of this size.
        """
        each = data.rate_per_h[:, np.newaxis] * data.visit_s
        self._scale = float(each.max(initial=0.0)) or 1.0
        self._driving.value = each / self._scale
        self._rate.value = data.rate_per_h
        self._bend.value = np.sqrt(data.congestion_s_h / self._scale)
        self._pods.value = data.pods
        self._places.value = data.places

    def run(self, limits: Limits) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
        """Solve with the numbers filled in.

        Parameters
        ----------
        limits
            Limits of the interior-point method.

        Returns
        -------
        Approximate number of pods of each class in each zone, shape (I, J); approximate price of a
        place in each zone, shape (J,); and the number of iterations. Zeros if the solver failed.
        """
        options = {} if limits.iterations is None else {"max_iter": limits.iterations}
        with warnings.catch_warnings():
            # cvxpy warns about inexact ends; the gap says more
            warnings.simplefilter("ignore")
            try:
                self._problem.solve(  # type: ignore[no-untyped-call]
                    solver=cp.CLARABEL, warm_start=False, **options
                )
            except cp.SolverError:
                # the variables may still hold what an earlier solve left in them
                self._standing.value = None
        statistics = self._problem.solver_stats
        iterations = 0 if statistics is None else int(statistics.num_iters or 0)
        standing, price = self._standing.value, self._fit.dual_value
        if standing is None or price is None:
            return np.zeros(self._standing.shape), np.zeros(self._places.shape), iterations
        return np.asarray(standing), np.asarray(price) * self._scale, iterations


@lru_cache(maxsize=_SIZES_KEPT)
def _compiled(classes: int, zones: int) -> _Programme:
    return _Programme(classes, zones)
