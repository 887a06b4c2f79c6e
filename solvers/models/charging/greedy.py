r"""Greedy heuristic: robots choose their stays in turn, lowest battery level first.

This is repeated until a round changes no choice or the maximum number of rounds is reached.

For the lower bound, each robot pays a price :math:`\lambda_t` for being away in time slot t. Let
:math:`m_t(a)` be the cost of missing robots in time slot t if the number of robots away is
:math:`a`. For any price,

.. math:: m_t(away_t) \ge \lambda_t\, away_t + \min_a \bigl(m_t(a) - \lambda_t a\bigr).

If the right-hand side replaces the cost of missing robots, and the limits `places` are dropped, the
robots can choose their stays independently; the minimum cost of these choices is a lower bound. The
heuristic computes this bound for three sets of prices, derived from its plan: the marginal cost of
sending one more robot away, that of sending one fewer, and the mean of both. It returns the best
bound.
"""

from __future__ import annotations

import math
from time import perf_counter

import numpy as np

from rmfs.solvers.models.charging.columns import Columns, columns
from rmfs.solvers.models.charging.data import (
    ChargePlan,
    Charging,
    Floats,
    Integers,
    objective,
    violations,
)
from rmfs.solvers.models.checks import require
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule

ROUNDS = 10
"""Maximum number of rounds in which all robots choose."""


def solve(
    data: Charging,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: ChargePlan | None = None,
) -> Solution[ChargePlan]:
    """Let each robot in turn choose the cheapest stay, given the stays of the others.

    Parameters
    ----------
    data
        The problem.
    limits
        `iterations` limits the number of rounds; every robot chooses once per round. Default: 10.
    seed
        Not used.
    start
        A plan to start from. Default: no robot has a stay.

    Returns
    -------
    The plan and the lower bound. The work is the number of stays evaluated.
    """
    began = perf_counter()
    table = columns(data)
    rows, work = _choose(data, table, limits, start)
    plan = table.plan(rows)
    value = objective(data, plan)
    return solution_of_rule(
        plan,
        lambda plan: value,
        bound=max(_bound(data, table, prices) for prices in _prices(data, table, rows)),
        work=work,
        began=began,
        built=float(table.away.size),
    )


def _choose(
    data: Charging, table: Columns, limits: Limits, start: ChargePlan | None
) -> tuple[Integers, float]:
    """Choose a row for every robot, until a round changes nothing."""
    rows = table.first[:-1].copy()
    if start is not None:
        broken = violations(data, start)
        require(not broken, "start", "; ".join(broken))
        rows = table.rows(start)
    gone = table.away[rows].sum(axis=0)
    # the last row is of those who are nowhere
    taken = np.zeros((len(data.gain) + 1, data.slots), np.int64)
    for row in rows.tolist():
        taken[table.group[row]] += table.used[row]
    order = np.argsort(data.level, kind="stable").tolist()
    rounds = ROUNDS if limits.iterations is None else limits.iterations
    work = 0.0
    for _ in range(rounds):
        changed = False
        for robot in order:
            own = int(rows[robot])
            gone -= table.away[own]
            taken[table.group[own]] -= table.used[own]
            best = _best(data, table, robot, gone, taken)
            gone += table.away[best]
            taken[table.group[best]] += table.used[best]
            changed |= best != own
            rows[robot] = best
        work += len(table.robot)
        if not changed:
            break
    return rows, work


def _best(data: Charging, table: Columns, robot: int, gone: Integers, taken: Integers) -> int:
    """Find the row of a robot that costs least; the first of equals."""
    mine = slice(int(table.first[robot]), int(table.first[robot + 1]))
    more_s = data.missing_s(gone + 1) - data.missing_s(gone)
    cost_s = table.cost_s[mine] + table.away[mine] @ more_s
    full = np.vstack([taken[:-1] >= data.places, np.zeros((1, data.slots), bool)])
    blocked = (table.used[mine] & full[table.group[mine]]).any(axis=1)
    cost_s = np.where(blocked, math.inf, cost_s)
    return mine.start + int(cost_s.argmin())


def _prices(data: Charging, table: Columns, rows: Integers) -> list[Floats]:
    """Return the prices to try: marginal costs of one more and one fewer robot away per slot."""
    gone = table.away[rows].sum(axis=0)
    more_s = data.missing_s(gone + 1) - data.missing_s(gone)
    less_s = data.missing_s(gone) - data.missing_s(gone - 1)
    return [more_s, less_s, (more_s + less_s) / 2]


def _bound(data: Charging, table: Columns, prices: Floats) -> float:
    """Return the lower bound at given prices of time away, without the limits `places`."""
    # the fewest that work can miss at these prices: convex in those away, a slope for each price
    away = np.arange(data.robots + 1)
    missed = np.maximum(data.wanted[:, :, np.newaxis] - data.robots + away, 0).mean(axis=0)
    fixed = (data.missed_s * missed - prices[:, np.newaxis] * away).min(axis=1)
    each = table.cost_s + table.away @ prices
    least = np.minimum.reduceat(each, table.first[:-1]) if data.robots else np.zeros(0)
    bound = math.fsum(least.tolist()) + math.fsum(fixed.tolist())
    # sums are rounded
    return bound - 1e-9 * max(1.0, abs(bound))
