"""How long drawing takes (`make bench`); each also checks what was drawn."""

from __future__ import annotations

import numpy as np
import pytest

from rmfs.scenario import BundleSource, OrderSource, SkuSet, initial_stock
from rmfs.scenario.parameters import Orders

pytestmark = pytest.mark.benchmark


def test_an_order_with_plenty_in_stock(benchmark, skus: SkuSet):
    source = OrderSource(Orders(), skus, seed=1)
    stock = np.full(len(skus), 100)
    order = benchmark(source.draw, 42, stock)
    assert order.redraws == 0


def test_an_order_with_little_in_stock(benchmark, skus: SkuSet):
    source = OrderSource(Orders(), skus, seed=1)
    stock = np.where(np.arange(len(skus)) % 50 == 0, 3, 0)
    order = benchmark(source.draw, 42, stock)
    assert all(stock[sku] for sku in order.skus)


def test_a_bundle(benchmark, skus: SkuSet):
    source = BundleSource(skus, seed=1)
    assert benchmark(source.draw, 42).units >= 4


def test_stock_of_two_thousand_pods(benchmark, skus: SkuSet):
    stock = benchmark(initial_stock, skus, np.full(2000, 500.0), 0.7, 1)
    assert stock.share >= 0.7
