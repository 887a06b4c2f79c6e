"""Orders from backlog demand: contents, redraws, and what they depend on."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest
from scipy import stats

from rmfs.errors import InputError
from rmfs.scenario import OrderSource, SkuSet
from rmfs.scenario.counts import NormalCount
from rmfs.scenario.orders import DRAWS_PER_LINE
from rmfs.scenario.parameters import Orders

ONE = NormalCount(mean=1.0, sd=0.0, min=1, max=1)
TWO = NormalCount(mean=2.0, sd=0.0, min=2, max=2)
SINGLE = Orders(lines=ONE, units_per_line=ONE)
PLENTY = 10**6


def plenty(skus: SkuSet) -> np.ndarray:
    return np.full(len(skus), PLENTY)


def test_lines_units_and_skus_follow_their_distributions(skus: SkuSet):
    config = Orders()
    source = OrderSource(config, skus, seed=1)
    orders = [source.draw(k, plenty(skus)) for k in range(20_000)]
    assert all(order.redraws == 0 for order in orders)
    for observed, distribution in (
        ([len(order.skus) for order in orders], config.lines),
        ([units for order in orders for units in order.units], config.units_per_line),
    ):
        counts = np.bincount(observed)[1:]
        expected = distribution.probabilities()[: len(counts)]
        assert stats.chisquare(counts, expected / expected.sum() * len(observed)).pvalue > 0.01
    first = np.bincount([order.skus[0] for order in orders], minlength=len(skus))
    expected = skus.by_popularity.probabilities * len(orders)
    assert stats.chisquare(first, expected).pvalue > 0.01


def test_an_order_names_no_sku_twice(few_skus: SkuSet):
    lines = NormalCount(mean=4.0, sd=0.0, min=4, max=4)
    source = OrderSource(Orders(lines=lines, units_per_line=ONE), few_skus, seed=1)
    for k in range(200):
        order = source.draw(k, plenty(few_skus))
        assert sorted(order.skus) == [0, 1, 2, 3]
        assert order.redraws == 0


def test_an_order_depends_on_its_ordinal_and_nothing_before_it(skus: SkuSet):
    stock = np.random.default_rng(1).integers(0, 4, len(skus))
    forwards = OrderSource(Orders(), skus, seed=7)
    backwards = OrderSource(Orders(), skus, seed=7)
    drawn = {k: forwards.draw(k, stock) for k in range(300)}
    assert {k: backwards.draw(k, stock) for k in reversed(range(300))} == drawn
    assert OrderSource(Orders(), skus, seed=8).draw(5, stock) != drawn[5]


def test_orders_change_only_where_stock_is_short(skus: SkuSet):
    """Two arms with one seed get the same lines but for those that one of them cannot serve."""
    orders = Orders(lines=NormalCount(mean=4.0, sd=0.0, min=4, max=4), units_per_line=ONE)
    source = OrderSource(orders, skus, seed=1)
    short = plenty(skus)
    short[np.argsort(skus.popularity)[-50:]] = 0
    same = changed = 0
    for k in range(500):
        rich, poor = source.draw(k, plenty(skus)), source.draw(k, short)
        assert rich.due_offset_s == poor.due_offset_s
        for wanted, got in zip(rich.skus, poor.skus, strict=True):
            if short[wanted]:
                same += wanted == got
                changed += wanted != got
    # a replacement may happen to be the SKU of a later line, which is then replaced in turn
    assert changed < 0.01 * same


@pytest.mark.parametrize("popular_stock", [0, 1])
def test_redrawing_is_renormalising(few_skus: SkuSet, popular_stock: int):
    orders = Orders(lines=ONE, units_per_line=TWO)
    source = OrderSource(orders, few_skus, seed=2)
    stock = np.array([popular_stock, 2, 2, 2, 2])
    drawn = [source.draw(k, stock) for k in range(6000)]
    counts = np.bincount([order.skus[0] for order in drawn], minlength=5)
    assert counts[0] == counts[4] == 0
    assert stats.chisquare(counts[1:4], [3000, 2000, 1000]).pvalue > 0.01
    # each draw misses with probability 0.4: redraws are geometric
    redraws = np.array([order.redraws for order in drawn])
    assert redraws.mean() == pytest.approx(0.4 / 0.6, rel=0.05)


def test_the_rare_sku_is_found_when_redrawing_takes_too_long():
    rare = SkuSet(
        ids=np.arange(3),
        popularity=np.array([1.0, 1e-9, 3e-9]),
        space_per_unit=np.ones(3),
        bundle_units=np.ones(3, dtype=np.int64),
    )
    source = OrderSource(SINGLE, rare, seed=1)
    drawn = [source.draw(k, np.array([0, 1, 1])) for k in range(2000)]
    assert {order.redraws for order in drawn} == {DRAWS_PER_LINE}
    counts = np.bincount([order.skus[0] for order in drawn])
    assert stats.chisquare(counts[1:], [500, 1500]).pvalue > 0.01


def test_no_order_where_no_sku_qualifies(few_skus: SkuSet):
    source = OrderSource(Orders(lines=TWO, units_per_line=TWO), few_skus, seed=1)
    assert source.draw(0, np.zeros(5, dtype=np.int64)) is None
    assert source.draw(0, np.array([1, 1, 1, 1, 9])) is None
    assert source.draw(0, np.array([9, 1, 1, 1, 9])) is None  # one SKU for two lines
    assert source.draw(0, np.array([9, 1, 2, 1, 9])).skus in ((0, 2), (2, 0))


def test_stock_is_never_oversold(few_skus: SkuSet):
    source = OrderSource(Orders(), few_skus, seed=1)
    stock = np.array([30, 30, 30, 30, 30])
    served = 0
    for k in range(500):
        order = source.draw(k, stock)
        if order is None:
            continue
        served += sum(order.units)
        for sku, units in zip(order.skus, order.units, strict=True):
            stock[sku] -= units
        assert (stock >= 0).all()
    assert stock[4] == 30
    assert served == 150 - stock.sum()
    assert stock[:4].sum() == 0


def test_drawing_leaves_the_stock_alone(few_skus: SkuSet):
    stock = np.array([0, 0, 1, 2, 3])
    OrderSource(Orders(), few_skus, seed=1).draw(0, stock)
    assert stock.tolist() == [0, 0, 1, 2, 3]


def test_more_lines_than_skus_are_refused(few_skus: SkuSet):
    orders = Orders(lines=NormalCount(mean=6.0, sd=0.0, min=6, max=6))
    with pytest.raises(InputError, match=r"demo: orders: lines.max = 6 exceeds the 5 SKUs"):
        OrderSource(orders, few_skus, seed=1, source="demo")


def test_the_first_thousand_orders_are_the_same_on_every_machine(skus: SkuSet):
    stock = np.arange(1000) % 5
    source = OrderSource(Orders(), skus, seed=1)
    drawn = [source.draw(k, stock) for k in range(1000)]
    assert (
        hashlib.sha256(repr([tuple(order)[:4] for order in drawn]).encode()).hexdigest()
        == FIRST_ORDERS
    )


FIRST_ORDERS = "90f83d3cfa70e018aada79389834fd4cda381fe005763e77acec0c2b819309e7"
