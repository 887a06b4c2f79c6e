"""Pauses by stock level, and the rest after a failure."""

from __future__ import annotations

from rmfs.scenario import BundleTopUp, OrderTopUp
from rmfs.scenario.parameters import BacklogDemand, BacklogReplenishment
from rmfs.scenario.top_up import Hysteresis


def test_hysteresis_changes_beyond_its_levels_only():
    switch = Hysteresis(on_above=0.6, off_below=0.1, on=True)
    levels = [0.5, 0.1, 0.09, 0.3, 0.6, 0.61, 0.2]
    assert [switch.update(level) for level in levels] == [
        True,
        True,
        False,
        False,
        False,
        True,
        True,
    ]


def test_orders_are_topped_up_to_their_number():
    top_up = OrderTopUp(BacklogDemand(orders=200), capacity=1000.0)
    assert top_up.wants(0.0, waiting=199, stored=700.0)
    assert not top_up.wants(0.0, waiting=200, stored=700.0)


def test_orders_pause_at_low_stock_and_resume_at_high_stock():
    top_up = OrderTopUp(BacklogDemand(), capacity=1000.0)
    stored = [700.0, 100.0, 99.0, 101.0, 600.0, 601.0, 101.0]
    assert [top_up.wants(0.0, 0, level) for level in stored] == [
        True,
        True,
        False,
        False,
        False,
        True,
        True,
    ]


def test_a_pause_begins_even_while_the_backlog_is_full():
    top_up = OrderTopUp(BacklogDemand(orders=1), capacity=1000.0)
    assert not top_up.wants(0.0, waiting=1, stored=50.0)
    assert not top_up.wants(0.0, waiting=0, stored=500.0)


def test_bundles_pause_at_high_load_and_resume_at_low_load():
    top_up = BundleTopUp(BacklogReplenishment(), capacity=1000.0)
    loads = [800.0, 850.0, 851.0, 700.0, 650.0, 649.0, 800.0]
    assert [top_up.wants(0.0, 0, load) for load in loads] == [
        True,
        True,
        False,
        False,
        False,
        True,
        True,
    ]


def test_pauses_can_be_switched_off():
    orders = OrderTopUp(BacklogDemand(pause_by_stock=False), capacity=1000.0)
    bundles = BundleTopUp(BacklogReplenishment(pause_by_stock=False), capacity=1000.0)
    assert orders.wants(0.0, 0, stored=0.0)
    assert bundles.wants(0.0, 0, load=5000.0)


def test_a_failure_blocks_for_a_minute():
    for top_up in (
        OrderTopUp(BacklogDemand(), capacity=1000.0),
        BundleTopUp(BacklogReplenishment(), capacity=1000.0),
    ):
        assert top_up.wants(10.0, 0, 700.0)
        top_up.failed(10.0)
        assert top_up.blocked_until_s == 70.0
        assert not top_up.wants(69.9, 0, 700.0)
        assert top_up.wants(70.0, 0, 700.0)


def test_a_bundle_is_accepted_up_to_the_limit_in_space_units():
    top_up = BundleTopUp(BacklogReplenishment(load_limit_share=1.1), capacity=1000.0)
    assert top_up.accepts(load=1050.0, space=50.0)
    assert not top_up.accepts(load=1050.0, space=51.0)
