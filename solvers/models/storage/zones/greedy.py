"""Turnover-based storage: the classes with most visits take the best zones."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np

from solvers.models.solution import NO_LIMITS, Limits, Solution, Status
from solvers.models.storage.zones.data import ZonePlan, Zones, objective
from solvers.models.storage.zones.prices import price_bound

_PORTIONS = 16
"""Parts in which a class is put down, so that congestion is felt on the way."""


def solve(
    data: Zones, limits: Limits = NO_LIMITS, *, seed: int = 0, start: ZonePlan | None = None
) -> Solution[ZonePlan]:
    """Put portions of the classes, most visited first, where a visit takes least time then.

    The time includes the delay that its traffic causes. The price of a zone is what its places
    save against the best zone with room that is left over.

    Parameters
    ----------
    data
        The problem.
    limits, seed, start
        Not needed.

    Returns
    -------
    The plan; ties go to the lowest index.
    """
    begin = perf_counter()
    if not data.fits:
        return Solution(
            None, math.inf, math.inf, Status.INFEASIBLE, "rule", perf_counter() - begin
        )
    standing = np.zeros(data.visit_s.shape)
    room = data.places.copy()
    traffic = np.zeros(len(room))
    steps = 0
    for kind in np.argsort(-data.rate_per_h, kind="stable").tolist():
        left, rate = float(data.pods[kind]), float(data.rate_per_h[kind])
        portion = left / _PORTIONS
        while left > 0 and (room > 0).any():
            visit_s = data.visit_s[kind] + 2.0 * data.congestion_s_h * traffic
            zone = int(np.where(room > 0, visit_s, math.inf).argmin())
            amount = min(portion, left, float(room[zone]))
            standing[kind, zone] += amount
            traffic[zone] += rate * amount
            room[zone] -= amount
            left -= amount
            steps += 1
    plan = ZonePlan(standing, _prices(data, standing, room))
    value = objective(data, plan)
    bound = min(value, price_bound(data, plan)) if data.pods.size else 0.0
    return Solution(
        plan, value, bound, Status.FEASIBLE, "rule", perf_counter() - begin, 0.0, float(steps)
    )
