r"""A Lagrangian bound for inputs of any size.

The bound ignores slots and the rule that the lines of an order must be served together. The rule
that a line l is served at most once is replaced by a price :math:`\pi_l \ge 0`, which every visit
that serves the line pays (Lagrangian relaxation). Two problems remain. An assignment problem
decides which pod makes which new visit. For each visit and SKU, a knapsack problem, bounded by its
linear relaxation, decides which lines the visit serves with the stock of its pod. Every new visit
must serve at least one line. The bound is valid for any prices; subgradient steps improve it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import linear_sum_assignment

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.solvers.models.planning.data import Integers, Planning, Reals

    Flags = NDArray[np.bool_]

_SLACK = 1e-9
"""Relative amount by which the bound is lowered to allow for rounding."""


def bound(data: Planning, value: float, steps: int) -> float:
    """Return a lower bound on the objective of every plan.

    Parameters
    ----------
    value
        Objective of a known plan. It determines the length of the subgradient steps, and the
        returned bound never exceeds it.
    steps
        Number of subgradient steps; with 0 the bound is -inf.
    """
    best = -np.inf
    prices = np.zeros(data.lines)
    worth = _line_worth(data)
    pace, idle = 1.0, 0
    for _ in range(steps):
        found, times = _relaxed(data, worth, prices)
        if found > best:
            best, idle = found, 0
        else:
            idle += 1
            pace = pace / 2 if idle % 3 == 0 else pace
        excess = times - 1.0
        excess[(prices <= 0) & (excess < 0)] = 0.0
        size = float((excess * excess).sum())
        if size <= 0 or value - found <= 0:
            break
        prices = np.maximum(prices + pace * (value - found) / size * excess, 0.0)
    if not np.isfinite(best):
        return best
    return min(float(best - _SLACK * max(1.0, abs(best), float(worth.sum()))), value)


def _line_worth(data: Planning) -> Reals:
    """Return the worth of each line plus an equal share of its order's worth, shape (L,).

    The worth of an order is earned when its last line is served. Its shares are earned no later, so
    they are discounted no more.
    """
    count = np.bincount(data.line_order, minlength=data.orders)
    shares = data.order_worth / np.maximum(count, 1)
    worth: Reals = data.line_worth + shares[data.line_order]
    return worth


def _settled(data: Planning) -> float:
    """Return the worth of the open orders that pods under way complete by themselves."""
    count = np.bincount(data.line_order, minlength=data.orders)
    done = (count == 0) & (data.order_until >= 0)
    return float((data.order_worth[done] * data.decay ** data.order_until[done]).sum())


def _relaxed(data: Planning, worth: Reals, prices: Reals) -> tuple[float, Reals]:
    """Return the bound at given prices, and how often it serves each line, shape (L,)."""
    times = np.zeros(data.lines)
    total = float(prices.sum())
    gains, visits = [], []
    at = data.order_station[data.line_order]
    enough = data.stock[:, data.line_sku] >= data.line_units
    for station in range(data.stations):
        mine = np.flatnonzero((at < 0) | (at == station))
        first = len(data.under_way[station])
        for visit in range(first + data.visits):
            net = worth[mine] * data.decay**visit - prices[mine]
            lines = mine[net > 0]
            if visit < first:
                pods = np.array(data.under_way[station][visit : visit + 1])
                total += float(_served(data, lines, net[net > 0], pods)[0])
                times += _amounts(data, lines, net[net > 0], int(pods[0]))
                continue
            gain = _served(data, lines, net[net > 0], np.arange(data.pods))
            # nobody comes in vain: without a line that pays, the one that costs least
            least = np.where(enough[:, mine], net, -np.inf).max(axis=1, initial=-np.inf)
            gain = np.where(gain > 0, gain, least)
            gains.append(gain - data.cost[:, station] * data.decay**visit)
            visits.append((mine, net))
    if gains:
        table = np.maximum(np.array(gains), 0.0)
        row, pod = linear_sum_assignment(table, maximize=True)
        total += float(table[row, pod].sum())
        for r, p in zip(row.tolist(), pod.tolist(), strict=True):
            if gains[r][p] > 0:
                times += _taken(data, *visits[r], p, enough[p])
    return -(total + _settled(data)), times


def _taken(data: Planning, mine: Integers, net: Reals, pod: int, enough: Flags) -> Reals:
    """Return how much of each line a new visit serves in the relaxation, shape (L,)."""
    amount = _amounts(data, mine[net > 0], net[net > 0], pod)
    if not amount.any():
        amount[mine[np.where(enough[mine], net, -np.inf).argmax()]] = 1.0
    return amount


def _served(data: Planning, lines: Integers, net: Reals, pods: Integers) -> Reals:
    """Return an upper bound on what each pod gains by serving lines from its stock, shape (p,)."""
    gain = np.zeros(len(pods))
    for sku in np.unique(data.line_sku[lines]).tolist():
        chosen = np.flatnonzero(data.line_sku[lines] == sku)
        units = data.line_units[lines[chosen]]
        order = np.argsort(-net[chosen] / units, kind="stable")
        used = np.concatenate([[0.0], np.cumsum(units[order])])
        earned = np.concatenate([[0.0], np.cumsum(net[chosen][order])])
        gain += np.interp(data.stock[pods, sku], used, earned)
    return gain


def _amounts(data: Planning, lines: Integers, net: Reals, pod: int) -> Reals:
    """Return how much of each line a pod serves in the relaxation, shape (L,)."""
    amount = np.zeros(data.lines)
    density = net / data.line_units[lines]
    left = data.stock[pod].astype(np.float64)
    for number in np.argsort(-density, kind="stable").tolist():
        line = int(lines[number])
        sku, units = data.line_sku[line], data.line_units[line]
        share = min(1.0, left[sku] / units)
        amount[line] = share
        left[sku] -= share * units
    return amount
