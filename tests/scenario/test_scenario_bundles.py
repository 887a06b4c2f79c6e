"""Bundles and the stock at time zero."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest
from scipy import stats

from rmfs.errors import InputError
from rmfs.scenario import BundleSource, SkuSet, initial_stock


def test_bundles_follow_popularity_and_size(few_skus: SkuSet):
    source = BundleSource(few_skus, seed=1)
    drawn = [source.draw(k) for k in range(5000)]
    counts = np.bincount([bundle.sku for bundle in drawn], minlength=5)
    assert counts[4] == 0
    assert stats.chisquare(counts[:4], [2000, 1500, 1000, 500]).pvalue > 0.01
    assert all(bundle.units == 4 for bundle in drawn)
    assert all(bundle.space == 4 * (bundle.sku + 1) for bundle in drawn)


def test_a_bundle_depends_on_its_ordinal_only(skus: SkuSet):
    forwards = BundleSource(skus, seed=3)
    drawn = [forwards.draw(k) for k in range(100)]
    backwards = BundleSource(skus, seed=3)
    assert [backwards.draw(k) for k in reversed(range(100))] == drawn[::-1]
    other = BundleSource(skus, seed=4)
    assert [other.draw(k) for k in range(100)] != drawn


def test_stock_reaches_its_share_and_no_pod_overflows(skus: SkuSet):
    capacity = np.full(200, 500.0)
    stock = initial_stock(skus, capacity, 0.7, seed=1)
    units = stock.contents(200, len(skus))
    used = units @ skus.space_per_unit
    assert (used <= capacity).all()
    assert used.sum() / capacity.sum() == pytest.approx(stock.share)
    assert 0.7 <= stock.share < 0.7 + skus.bundle_space.max() / capacity.sum()
    assert (units % skus.bundle_units == 0).all()


def test_stock_is_repeatable_and_depends_on_the_seed(skus: SkuSet):
    capacity = np.full(100, 500.0)
    first, again = (initial_stock(skus, capacity, 0.5, seed=1) for _ in range(2))
    other = initial_stock(skus, capacity, 0.5, seed=2)
    assert (first.pod == again.pod).all()
    assert (first.sku == again.sku).all()
    assert first.sku[:50].tolist() != other.sku[:50].tolist()


def test_pods_are_chosen_alike_and_skus_by_popularity(few_skus: SkuSet):
    stock = initial_stock(few_skus, np.full(100, 1000.0), 0.5, seed=1)
    pods = np.bincount(stock.pod, minlength=100)
    assert stats.chisquare(pods).pvalue > 0.01
    counts = np.bincount(stock.sku, minlength=5)
    expected = few_skus.by_popularity.probabilities[:4] * len(stock.sku)
    assert counts[4] == 0
    assert stats.chisquare(counts[:4], expected).pvalue > 0.01


def test_filling_ends_when_nothing_fits(few_skus: SkuSet):
    """Bundles take 4, 8, 12 and 16 units of space; what is left over takes no more."""
    stock = initial_stock(few_skus, np.full(10, 23.0), 1.0, seed=1)
    used = stock.contents(10, 5) @ few_skus.space_per_unit
    assert stock.share < 1.0
    assert (23.0 - used < 4.0).all()


def test_filling_to_the_brim_is_exact(few_skus: SkuSet):
    stock = initial_stock(few_skus, np.full(10, 24.0), 1.0, seed=1)
    assert stock.share == 1.0


def test_nothing_is_stored_for_a_share_of_zero(few_skus: SkuSet):
    stock = initial_stock(few_skus, np.full(10, 24.0), 0.0, seed=1)
    assert len(stock.pod) == len(stock.sku) == len(stock.units) == 0
    assert stock.share == 0.0
    assert stock.contents(10, 5).sum() == 0


def test_pods_of_different_capacity(few_skus: SkuSet):
    capacity = np.array([4.0, 8.0, 40.0, 400.0])
    stock = initial_stock(few_skus, capacity, 1.0, seed=1)
    assert (stock.contents(4, 5) @ few_skus.space_per_unit == capacity).all()


def test_a_rule_may_choose_the_pods(skus: SkuSet):
    """The SKUs stay the same whatever rule places them, as long as all of them fit."""
    capacity = np.full(50, 500.0)
    emptiest = initial_stock(
        skus, capacity, 0.6, seed=1, choose=lambda bundle, free: int(np.argmax(free))
    )
    by_chance = initial_stock(skus, capacity, 0.6, seed=1)
    used = emptiest.contents(50, len(skus)) @ skus.space_per_unit
    assert np.ptp(used) <= skus.bundle_space.max()
    assert (emptiest.sku == by_chance.sku).all()


def test_a_rule_is_not_asked_for_what_fits_nowhere(few_skus: SkuSet):
    def first_with_room(bundle, free):
        assert free.max() >= bundle.space
        return int(np.argmax(free >= bundle.space))

    stock = initial_stock(few_skus, np.full(10, 23.0), 1.0, seed=1, choose=first_with_room)
    assert (23.0 - stock.contents(10, 5) @ few_skus.space_per_unit < 4.0).all()


def test_a_rule_that_chooses_a_full_pod_is_caught(few_skus: SkuSet):
    with pytest.raises(ValueError, match="pod 0 has no room"):
        initial_stock(few_skus, np.full(10, 23.0), 1.0, seed=1, choose=lambda bundle, free: 0)


def test_a_bundle_larger_than_every_pod_is_refused(few_skus: SkuSet):
    with pytest.raises(InputError, match="do not fit into any pod"):
        initial_stock(few_skus, np.full(10, 19.0), 0.5, seed=1)


def test_stock_and_bundles_are_the_same_on_every_machine(skus: SkuSet):
    stock = initial_stock(skus, np.full(100, 500.0), 0.99, seed=1)
    source = BundleSource(skus, seed=1)
    drawn = [(bundle.sku, bundle.units) for bundle in map(source.draw, range(1000))]
    text = repr((stock.pod.tolist(), stock.sku.tolist(), stock.units.tolist(), drawn))
    assert hashlib.sha256(text.encode()).hexdigest() == STOCK_AND_BUNDLES


STOCK_AND_BUNDLES = "f7584325889b725c2258f70694bb10953f25d2a19e35957e15494bae12ff0991"
