"""Tie-breaking between equally good orders."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.world.backlog import OrderBacklog
    from rmfs.world.orders import Order

TieBreaker = Literal["due-time", "first-come", "random"]


def first_row(
    rows: NDArray[np.intp],
    orders: OrderBacklog,
    tie_breaker: TieBreaker,
    draw: Callable[[int], int],
) -> int:
    """Return the row that the tie-breaker prefers among the given rows of the backlog.

    If the tie-breaker is `due-time` and due times are equal, the order that arrived first wins.

    Parameters
    ----------
    rows
        Rows of the tied orders in `orders`, at least one.
    draw
        Function that draws an integer from 0 to its argument minus 1.
    """
    if len(rows) == 1:
        return int(rows[0])
    if tie_breaker == "random":
        return int(rows[draw(len(rows))])
    if tie_breaker == "due-time":
        due_s = orders.due_s[rows]
        rows = rows[due_s == due_s.min()]
    return int(rows[orders.index[rows].argmin()])


def order_rank(
    tie_breaker: TieBreaker, rng: np.random.Generator
) -> Callable[[Order], tuple[float, int]]:
    """Return a function that gives the rank of an order; the order with the smallest rank wins."""
    if tie_breaker == "random":
        return partial(_at_random, rng)
    return _by_due_time if tie_breaker == "due-time" else _by_arrival


def _at_random(rng: np.random.Generator, order: Order) -> tuple[float, int]:
    return float(rng.random()), order.index


def _by_due_time(order: Order) -> tuple[float, int]:
    return order.due_s, order.index


def _by_arrival(order: Order) -> tuple[float, int]:
    return 0.0, order.index
