r"""A lower bound by Lagrangian relaxation, with prices for lines at stations; fast at every size.

Constraints (2) and (5) of `program` are dropped, as is a part of (6) if orders may be split over
stations. Constraint (1) is applied to all stations together. Constraint (8) is replaced by prices:
covering line l at station s costs :math:`\pi_{ls} \ge 0`, and a pod called to s earns the prices of
the lines that it could cover and :math:`\sigma_{sk}` for each unit of shortage that it could ease.
Let R be the number of free robots and :math:`cost_{ps}` the cost of calling pod p to station s; the
other symbols are those of the module `data`. For all prices, a lower bound is

.. math::

    & \textstyle\sum_p \min(0, \min_s (cost_{ps}
        - \sum_l \min(1, a_{pk(l)} / q_l)\, \pi_{ls}
        - \sum_k \min(a_{pk}, shortage_{sk})\, \sigma_{sk}))
      \quad \text{(of the pods that need a robot, only the R smallest terms)} \\
    & + \textstyle\sum_{s,k} shortage_{sk}\, \sigma_{sk}
      - \sum_{l,s} \min(1, surplus_{sk(l)} / q_l)\, \pi_{ls}
      + \text{orders}(\pi), \qquad 0 \le \sigma_{sk} \le open\_unit.

Here orders(π) is the least total cost of orders and empty slots at these prices. Each order gets a
slot, becomes a prospect, or neither, and the number of orders that get slots is limited by the
total number of free slots of all stations. If a pod needs a robot, its cost includes the trip of
the nearest free robot.

Initially, the price of a line at a station is the lowest cost per line of the pods that hold its
SKU: the cost of calling a pod, divided by the number of lines that the pod could cover. Subgradient
steps improve the prices. The step length is that of Polyak (1969), with the objective of a known
decision as the target value.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from rmfs.solvers.models.pile_on.candidates import fetch_estimate
from rmfs.solvers.models.pile_on.data import Flags, Floats, Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment
from rmfs.solvers.models.pile_on.variant import Variant
from rmfs.solvers.models.solution import Solution, Status

ITERATIONS = 40
"""Default number of subgradient steps."""

_PATIENCE = 5
"""Number of steps without a better bound after which the step length is halved."""

_ROUNDING = 1e-9
"""Relative allowance for rounding, far above the error of sums of a million doubles."""


def bound(data: PileOn, upper: float, iterations: int = ITERATIONS) -> float:
    """Return a lower bound on the objective of every decision.

    Parameters
    ----------
    data
        The input.
    upper
        Objective of a feasible decision, the target value of the steps. It affects only the quality
        of the bound, not its validity.
    iterations
        Number of subgradient steps. Default `ITERATIONS`.

    Returns
    -------
    The best bound over all steps, lowered slightly to allow for rounding errors.
    """
    dual = _Dual(data)
    price, relief = dual.start()
    best, length, waited = -np.inf, 1.0, 0
    for _ in range(iterations + 1):
        value, rise, ease = dual.value(price, relief)
        if value > best:
            best, waited = value, 0
        else:
            waited += 1
        if waited == _PATIENCE:
            length, waited = length / 2, 0
        norm = float((rise**2).sum() + (ease**2).sum())
        if norm == 0.0 or value >= upper:
            break
        step = length * (upper - value) / norm
        price = np.where(dual.priced, np.maximum(price + step * rise, 0.0), 0.0)
        relief = np.clip(relief + step * ease, 0.0, data.weights.open_unit)
    return min(best, upper)


def bounded(
    data: PileOn, found: Solution[Assignment], iterations: int = ITERATIONS, gap: float = 0.0
) -> Solution[Assignment]:
    """Replace the bound of a solution by that of the function `bound`, and update its status.

    Parameters
    ----------
    data
        The input.
    found
        The solution.
    iterations
        Number of subgradient steps. Default `ITERATIONS`.
    gap
        Relative gap at which the solution counts as optimal. Default 0.
    """
    cost = found.objective
    least = bound(data, cost, iterations)
    status = Status.OPTIMAL if cost - least <= gap * abs(cost) else Status.FEASIBLE
    return replace(found, bound=least, status=status)


@dataclass(frozen=True)
class _Orders:
    """The cheapest assignment of all orders: its cost, and the lines covered, shape (L, S)."""

    cost: float
    magnitude: float
    covered: Floats


class _Dual:
    """The bound as a function of the prices, with its subgradient."""

    def __init__(self, data: PileOn) -> None:
        self.data = data
        self._pods = np.flatnonzero(data.available)
        stock = data.stock[self._pods]
        cost = data.call_cost[self._pods] + fetch_estimate(data)[self._pods, None]
        self._cost = np.where(data.callable_to, cost, np.inf)
        held = stock[:, data.line_sku]
        self._brings = csr_array(np.minimum(held, data.line_units) / data.line_units)
        self._taken = self._brings.T.tocsr()
        self._short_station, sku = np.nonzero(data.shortage)
        self._short = data.shortage[self._short_station, sku].astype(np.float64)
        self._eases = np.minimum(stock[:, sku], self._short)
        self._at = np.eye(data.stations)[self._short_station]
        spare = np.minimum(data.surplus[:, data.line_sku].T / data.line_units[:, None], 1.0)
        self._spare = spare
        self.priced: Flags = (spare < 1.0) & (data.slots > 0)

    def start(self) -> tuple[Floats, Floats]:
        """Return initial prices at which no pod earns more than it costs: equal shares per line."""
        data, weights = self.data, self.data.weights
        most = (
            weights.empty_slot
            + float(data.reward.max(initial=0.0))
            + weights.line * max(data.lines, 1)
        )
        most += float(data.order_worth.max(initial=0.0))
        price = np.full((data.lines, data.stations), most)
        brought = np.maximum(np.asarray(self._brings.sum(axis=1)), 1.0)
        share = self._cost / brought[:, None]
        entry = self._brings.tocoo()
        np.minimum.at(price, entry.col, share[entry.row])
        return np.where(self.priced, price, 0.0), np.zeros(self._short.size)

    def value(self, price: Floats, relief: Floats) -> tuple[float, Floats, Floats]:
        """Return the bound, lowered for rounding, and its subgradients by both kinds of prices."""
        data = self.data
        earned = self._brings @ price + (self._eases * relief) @ self._at
        called = self._called(self._cost - earned)
        profit = (self._cost - earned)[called]
        orders = self._treat(price)
        spared = self._spare * price
        terms = (profit.sum(), (self._short * relief).sum(), -spared.sum(), orders.cost)
        offset = data.weights.empty_slot * float(data.slots.sum())
        size = np.abs(profit).sum() + abs(terms[1]) + abs(terms[2]) + orders.magnitude + offset
        value = float(sum(terms)) + offset
        use = called.astype(np.float64)
        rise = np.where(self.priced, orders.covered - self._spare - self._taken @ use, 0.0)
        ease = self._short - (self._eases * (use @ self._at.T)).sum(axis=0)
        return value - _ROUNDING * (1.0 + float(size)), rise, ease

    def _called(self, cost: Floats) -> Flags:
        """The pods worth calling at these prices, each at its best station, shape (pods, S)."""
        data = self.data
        called = np.zeros(cost.shape, dtype=np.bool_)
        if not cost.size:
            return called
        best = cost.argmin(axis=1)
        least = cost[np.arange(best.size), best]
        chosen = least < 0
        needs = np.flatnonzero(data.needs_robot[self._pods])
        dropped = needs[np.argsort(least[needs], kind="stable")[data.free_robots.size :]]
        chosen[dropped] = False
        called[chosen, best[chosen]] = True
        return called

    def _treat(self, price: Floats) -> _Orders:
        """Return the cheapest assignment of all orders, with the slots of all stations pooled."""
        data, weights = self.data, self.data.weights
        open_at = np.flatnonzero(data.slots > 0)
        covered = np.zeros(price.shape)
        if not data.orders or not open_at.size:
            return _Orders(0.0, 0.0, covered)
        paid = price[:, open_at]
        waiting = self._sums(paid) - data.reward[:, None]
        away = waiting.argmin(axis=1)
        rest = waiting[np.arange(data.orders), away]
        rest = np.minimum(rest, 0.0) if weights.prospects else np.zeros(data.orders)
        slot, takes, at = self._slot(paid - weights.line, open_at)
        extra = min(weights.part - weights.empty_slot, 0.0) if data.variant.many_stations else 0.0
        gain = slot - rest
        free = int(data.slots.sum())
        ranked = np.argsort(gain, kind="stable")[:free]
        placed = ranked[gain[ranked] < extra]
        cost = rest.sum() + gain[placed].sum() + extra * (free - placed.size)
        magnitude = np.abs(rest).sum() + np.abs(gain[placed]).sum() + abs(extra) * free
        has_slot = np.zeros(data.orders, dtype=np.bool_)
        has_slot[placed] = True
        line = np.flatnonzero(has_slot[data.line_order] & takes)
        covered[line, at[line]] = 1.0
        line = np.flatnonzero((~has_slot & (rest < 0))[data.line_order])
        covered[line, open_at[away[data.line_order[line]]]] = 1.0
        return _Orders(float(cost), float(magnitude), covered)

    def _slot(self, paid: Floats, open_at: Integers) -> tuple[Floats, Flags, Integers]:
        """Cost of an order with a slot (O,); the lines it then covers (L,), and where (L,)."""
        data, weights = self.data, self.data.weights
        order = data.line_order
        if data.variant.many_stations:
            best = paid.argmin(axis=1)
            paid = paid[np.arange(data.lines), best][:, None]
        part, full = self._part(paid), self._sums(paid) - data.reward[:, None]
        value = np.minimum(part, full)
        where = value.argmin(axis=1)
        orders = np.arange(data.orders)
        cost = value[orders, where] - weights.empty_slot - data.order_worth
        own = paid[np.arange(data.lines), where[order]]
        whole = (full <= part)[orders, where]
        least = np.minimum.reduceat(own, data.first_line[:-1])
        limit = weights.open_line if data.variant is Variant.LATER else 0.0
        takes = whole[order] | (own < limit)
        if data.variant.leaves_backlog:
            takes |= own == least[order]
        station = open_at[best] if data.variant.many_stations else open_at[where[order]]
        return cost, takes, station

    def _part(self, paid: Floats) -> Floats:
        """Least cost of the lines of an order with a slot that is not complete, (O, columns)."""
        variant = self.data.variant
        if variant is Variant.LATER:
            return self._sums(np.minimum(paid, self.data.weights.open_line))
        if variant.leaves_backlog:
            # One line at least is covered.
            least = np.minimum.reduceat(paid, self.data.first_line[:-1], axis=0)
            return self._sums(np.minimum(paid, 0.0)) + np.maximum(least, 0.0)
        return np.full((self.data.orders, paid.shape[1]), np.inf)

    def _sums(self, by_line: Floats) -> Floats:
        """Sums over the lines of each order, (L, columns) to (O, columns)."""
        total: Floats = np.add.reduceat(by_line, self.data.first_line[:-1], axis=0)
        return total
