"""Turnover-based storage: the classes whose pods make the most visits take the best zones."""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule
from rmfs.solvers.models.storage.zones.data import ZonePlan, Zones, objective, traffic_per_h
from rmfs.solvers.models.storage.zones.prices import price_bound

_PORTIONS = 16
"""Number of portions in which a class is placed, so that congestion affects later portions."""


def solve(
    data: Zones, limits: Limits = NO_LIMITS, *, seed: int = 0, start: ZonePlan | None = None
) -> Solution[ZonePlan]:
    """Place classes, the highest visit rate first, in the zones with the fastest visits.

    Each class is placed in portions. Each portion goes to the zone with room in which a visit takes
    the least robot time. This time includes the delay that one more visit causes to itself and to
    other visits.

    The saving of a class in a zone is the robot time per hour that each of its pods saves there,
    compared with the best zone that still has room. The price of a place in a zone is the smallest
    saving of the classes in the zone, but at least 0; it is 0 if the zone is empty or no zone has
    room.

    Returns
    -------
    The plan; ties go to the lowest index. The status is INFEASIBLE if there are fewer places than
    pods.
    """
    begin = perf_counter()
    if not data.fits:
        return solution_of_rule(
            None, lambda plan: objective(data, plan), bound=math.inf, work=0.0, began=begin
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
    return solution_of_rule(
        plan,
        lambda values: objective(data, values),
        bound=price_bound(data, plan) if data.pods.size else 0.0,
        work=float(steps),
        began=begin,
    )


def _prices(
    data: Zones, standing: NDArray[np.float64], room: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the price of a place in each zone, from the pods stored there."""
    free = np.flatnonzero(room > 0)
    if not free.size or not data.pods.size:
        return np.zeros(len(room))
    delay_s = 2.0 * data.congestion_s_h * traffic_per_h(data, standing)
    each = data.rate_per_h[:, np.newaxis] * (data.visit_s + delay_s)
    saved = each[:, free].min(axis=1)[:, np.newaxis] - each
    least = np.where(standing > 0, saved, math.inf).min(axis=0)
    prices: NDArray[np.float64] = np.where(np.isfinite(least), np.maximum(least, 0.0), 0.0)
    return prices
