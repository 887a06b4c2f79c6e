"""Counts that are kept up to date so that rules need not add them up."""

from __future__ import annotations

import numpy as np
import pytest
from doubles import Situation, small_layout, small_skus

from rmfs.world import verify


def skus_on(situation: Situation, pod: int) -> list[int]:
    """The SKUs listed for a pod, and that all else is filled up."""
    row = situation.world.inventory.skus_on[pod].tolist()
    count = len(situation.world.skus)
    listed = [sku for sku in row if sku < count]
    assert row == listed + [count] * (len(row) - len(listed))
    return sorted(listed)


class TestSkusOnPods:
    def test_from_the_first_unit_to_the_last(self) -> None:
        """Units that are bound still count, those picked do not."""
        situation = Situation()
        situation.stock(0, s1=2, s3=1)
        situation.stock(0, s1=1)
        assert skus_on(situation, 0) == [1, 3]
        assert skus_on(situation, 1) == []
        situation.assigned(s3=1)
        situation.carry(robot=0, pod=0)
        assert skus_on(situation, 0) == [1, 3]
        situation.world.pick_unit(situation.world.robots[0].task)
        assert skus_on(situation, 0) == [1]
        verify(situation.world)

    def test_any_number_of_skus(self) -> None:
        """Twenty on one pod; one of the first is picked, then a bundle of another comes."""
        situation = Situation(small_layout(pods=2), small_skus(21))
        for sku in range(20):
            situation.stock(1, **{f"s{sku}": 1})
        assert skus_on(situation, 1) == list(range(20))
        situation.assigned(s2=1)
        situation.carry(robot=0, pod=1)
        situation.world.pick_unit(situation.world.robots[0].task)
        situation.stock(1, s20=4)
        assert skus_on(situation, 1) == [0, 1, *range(3, 21)]
        verify(situation.world)

    def test_sums_per_pod(self) -> None:
        """Weights 1, 10, 100 ... of the SKUs, and 0 for "no SKU"."""
        situation = Situation()
        situation.stock(0, s0=5, s2=1)
        situation.stock(3, s1=1)
        weights = np.array([1, 10, 100, 1000, 10000, 0])
        sums = weights[situation.world.inventory.skus_on].sum(axis=1)
        assert sums.tolist() == [101, 0, 0, 10]


def test_units_ordered() -> None:
    """They count from arrival on, for ever."""
    situation = Situation()
    situation.stock(0, s0=5)
    situation.order(s0=2, s1=1)
    order = situation.assigned(s0=1)
    situation.carry(robot=0, pod=0)
    situation.world.pick_unit(situation.world.robots[0].task)
    situation.world.complete_order(order)
    assert situation.world.inventory.ordered.tolist() == [3, 1, 0, 0, 0]


def test_order_lines_at_stations() -> None:
    """Two orders at station 1 want SKU 0, whatever their units, until they are complete."""
    situation = Situation(small_layout(pick_stations=2))
    situation.stock(0, s0=5)
    first = situation.assigned(station=1, s0=1)
    situation.assigned(station=1, s0=4, s2=1)
    situation.order(s0=1)
    assert situation.world.lines.tolist() == [[0] * 5, [2, 0, 1, 0, 0]]
    situation.carry(robot=0, pod=0, station=1)
    situation.world.pick_unit(situation.world.robots[0].task)
    assert situation.world.lines[1].tolist() == [2, 0, 1, 0, 0]
    situation.world.complete_order(first)
    assert situation.world.lines[1].tolist() == [1, 0, 1, 0, 0]
    verify(situation.world)


def test_arrivals_of_the_backlog() -> None:
    """Rows change place when an order leaves; their arrivals go with them."""
    situation = Situation()
    orders = [situation.order(s0=1) for _ in range(70)]
    for order in (orders[0], orders[5]):
        situation.world.orders.remove(order)
    backlog = situation.world.orders
    assert [order.index for order in backlog.at_row] == backlog.index.tolist()
    assert sorted(backlog.index.tolist()) == [*range(1, 5), *range(6, 70)]


def test_pods_stored() -> None:
    situation = Situation()
    situation.stock(2, s0=1)
    situation.assigned(s0=1)
    situation.carry(robot=0, pod=2)
    assert situation.world.storage.is_stored.tolist() == [True, True, False, True]
    with pytest.raises(ValueError, match="read-only"):
        situation.world.storage.is_stored[0] = False
