"""Forecast of future orders, drawn from the orders known so far."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.orders import Order

KEPT = 1000
"""Number of past orders that are kept to draw from."""


@dataclass(frozen=True)
class ExpectedLine:
    """A line of a future order; attributes are named as in `OrderLine`."""

    sku: int
    open_units: int


@dataclass(frozen=True)
class ExpectedOrder:
    """A future order; attributes are named as in `Order`."""

    lines: tuple[ExpectedLine, ...]
    created_s: float
    due_s: float = inf
    weight: float = 1.0


class ExpectedOrders:
    """Draws future orders from known orders, at the rate at which orders have arrived so far.

    A controller does not know the arrival process or the orders to come. The orders known to it are
    those from before the run (`View.past_orders`), the initial backlog, and those that have arrived
    since the start.

    Parameters
    ----------
    view
        The world.
    rng
        Random generator with which orders are drawn.
    """

    def __init__(self, view: View, rng: np.random.Generator) -> None:
        self._view, self._rng = view, rng
        self._seen: deque[tuple[ExpectedLine, ...]] = deque(maxlen=KEPT)
        for content in view.past_orders:
            pairs = zip(content.skus, content.units, strict=True)
            self._seen.append(tuple(ExpectedLine(sku, units) for sku, units in pairs))
        for order in view.orders:
            self._keep(order)
        self._begin_s = view.now_s
        self._come = 0

    def hear(self, order: Order) -> None:
        """Record an order that has arrived."""
        self._keep(order)
        self._come += 1

    def draw(self, horizon_s: float, scenarios: int) -> list[list[ExpectedOrder]]:
        """Draw future orders; until the first order has arrived in the run, all draws are empty.

        Orders with a line that no single pod can serve are left out.

        Parameters
        ----------
        horizon_s
            Horizon in s. A draw contains the orders that arrive within the horizon; their number is
            Poisson-distributed.
        scenarios
            Number of draws.

        Returns
        -------
        The future orders of each draw.
        """
        elapsed_s = self._view.now_s - self._begin_s
        if not self._come or elapsed_s <= 0:
            return [[] for _ in range(scenarios)]
        number = self._rng.poisson(self._come * horizon_s / elapsed_s, scenarios)
        return [self._orders(count) for count in number.tolist()]

    def _orders(self, count: int) -> list[ExpectedOrder]:
        chosen = self._rng.integers(0, len(self._seen), count).tolist()
        drawn = [ExpectedOrder(self._seen[number], self._view.now_s) for number in chosen]
        return [order for order in drawn if self._servable(order.lines)]

    def _servable(self, lines: Sequence[ExpectedLine]) -> bool:
        available = self._view.inventory.available
        return all(available[line.sku].max(initial=0) >= line.open_units for line in lines)

    def _keep(self, order: Order) -> None:
        self._seen.append(tuple(ExpectedLine(line.sku, line.units) for line in order.lines))
