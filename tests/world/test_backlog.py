"""The backlog as a matrix."""

from __future__ import annotations

import numpy as np

from rmfs.world.backlog import OrderBacklog
from rmfs.world.orders import Order


def order(index: int, **units: int) -> Order:
    skus = tuple(int(sku[1:]) for sku in units)
    return Order.of(index, 0.0, 100.0 * index, skus, tuple(units.values()))


def test_rows_follow_orders_that_come_and_go() -> None:
    backlog = OrderBacklog()
    orders = [order(i, s1=i + 1, s2=1) for i in range(4)]
    for each in orders:
        backlog.add(each)
    backlog.remove(orders[1])
    assert [each.index for each in backlog] == [0, 2, 3]
    assert [each.index for each in backlog.at_row] == [0, 3, 2]
    assert backlog.units[:, 0].tolist() == [1, 4, 3]
    assert backlog.due_s.tolist() == [0.0, 300.0, 200.0]
    assert orders[1] not in backlog


def test_it_grows_in_both_directions() -> None:
    backlog = OrderBacklog()
    for index in range(200):
        backlog.add(order(index, **{f"s{sku}": 1 for sku in range(1 + index % 7)}))
    assert backlog.sku.shape == (200, 7)
    assert backlog.units.sum(axis=1).tolist() == [1 + index % 7 for index in range(200)]


def test_orders_after_an_index_come_latest_first() -> None:
    backlog = OrderBacklog()
    for index in range(5):
        backlog.add(order(index, s0=1))
    assert [each.index for each in backlog.after(2)] == [4, 3]


def test_an_order_is_servable_if_every_line_is() -> None:
    backlog = OrderBacklog()
    backlog.add(order(0, s0=2, s1=1))
    backlog.add(order(1, s1=1))
    backlog.add(order(2, s0=3))
    assert backlog.servable(np.array([2, 1])).tolist() == [True, True, False]


def test_lines_that_are_not_there_need_no_stock() -> None:
    """The missing second line of the order is written as SKU 0, of which the stock is short."""
    backlog = OrderBacklog()
    backlog.add(order(0, s1=1))
    assert backlog.servable(np.array([-5, 1])).tolist() == [True]
