"""Arrivals at random: gaps, rates in steps, high and low, rates tied to stations."""

from __future__ import annotations

import hashlib
from itertools import pairwise

import numpy as np
import pytest
from scenario_tools import DAY_US, SIGNIFICANT, SITE, FakeState, drive, scenario, times_s
from scipy import stats

from rmfs.errors import InputError
from rmfs.scenario import OrderSource, Site, SkuSet, bundle_intake, order_intake, sku_set
from rmfs.scenario.clock import NEVER_US, US_PER_H
from rmfs.scenario.intake.rates import rate_of
from rmfs.scenario.parameters.rates import BUNDLE_WEIGHTS, ORDER_WEIGHTS, HighLowRate, OrderSteps

DAY_S = 86400.0


def orders(skus: SkuSet, seed: int = 2, duration_s: float = DAY_S, state=None, **demand):
    given = scenario(duration_s, demand={"mode": "poisson", "initial_orders": 0} | demand)
    intake = order_intake(given, skus, SITE, seed)
    return drive(intake, state or FakeState(), round(duration_s * 1e6))


def bundles(skus: SkuSet, seed: int = 2, duration_s: float = DAY_S, **replenishment):
    table = {"mode": "poisson", "initial_bundles": 0} | replenishment
    intake = bundle_intake(scenario(duration_s, replenishment=table), skus, SITE, seed)
    return drive(intake, FakeState(), round(duration_s * 1e6))


def test_gaps_are_exponential_and_independent(skus: SkuSet):
    gaps = np.diff(times_s(orders(skus, orders_per_h=100)), prepend=0)
    assert stats.kstest(gaps, stats.expon(scale=9.0).cdf).pvalue > SIGNIFICANT
    assert stats.spearmanr(gaps[:-1], gaps[1:]).pvalue > SIGNIFICANT
    assert usual(len(gaps), 9600)


def usual(number: int, mean: float) -> bool:
    """Whether a Poisson variable may well have this value."""
    return bool(SIGNIFICANT < stats.poisson(mean).cdf(number) < 1 - SIGNIFICANT)


@pytest.mark.parametrize(
    ("come_of", "rate"),
    [
        (lambda skus, seed: orders(skus, seed, orders_per_h=25), 100),
        (lambda skus, seed: orders(skus, seed, orders_per_h=50, per_station=False), 50),
        (lambda skus, seed: bundles(skus, seed, bundles_per_h=50), 100),
        (lambda skus, seed: bundles(skus, seed, bundles_per_h=50, per_station=False), 50),
    ],
)
def test_rates_are_those_of_a_station_or_of_all(skus: SkuSet, come_of, rate):
    """Numbers of a day over ten seeds: their sum, and their spread around the mean."""
    numbers = np.array([len(come_of(skus, seed)) for seed in range(10)])
    mean = 24 * rate
    assert usual(int(numbers.sum()), 10 * mean)
    spread = ((numbers - mean) ** 2 / mean).sum()
    assert SIGNIFICANT < stats.chi2(10).cdf(spread) < 1 - SIGNIFICANT


@pytest.mark.parametrize(
    ("weights", "come_of"),
    [
        (ORDER_WEIGHTS, lambda skus: orders(skus, orders_per_h=160, profile={"kind": "steps"})),
        (BUNDLE_WEIGHTS, lambda skus: bundles(skus, bundles_per_h=160, profile={"kind": "steps"})),
    ],
)
def test_the_daily_profile_holds_hour_by_hour(skus: SkuSet, weights, come_of):
    """Given their number, arrivals are distributed as the profile says (its integral)."""
    come = times_s(come_of(skus))
    hours = np.histogram(come, bins=np.arange(25) * 3600.0)[0]
    expected = np.array(weights) / sum(weights) * len(come)
    assert stats.chisquare(hours, expected).pvalue > SIGNIFICANT
    cumulative = np.concatenate([[0.0], np.cumsum(weights)]) / sum(weights)
    integral = stats.kstest(come, lambda t: np.interp(t, np.arange(25) * 3600.0, cumulative))
    assert integral.pvalue > SIGNIFICANT


def test_the_mean_of_a_day_is_the_given_rate(skus: SkuSet):
    """Every step counts with its own length; RAWSim-O is one step off and misses the mean."""
    steps = {"kind": "steps", "cycle_s": 3600, "weights": [9, 1], "starts_s": [0, 900]}
    come = orders(skus, orders_per_h=100, profile=steps)
    assert usual(len(come), 9600)
    config = OrderSteps.model_validate(steps)
    rate = rate_of(config, 100.0, 4.0, 0.0, seed=1)
    assert (rate.per_h(0) * 900 + rate.per_h(900_000_000) * 2700) / 3600 == pytest.approx(400)
    assert rate.per_h(899_999_999) == 9 * rate.per_h(900_000_000) == rate.peak_per_h


def test_rates_hold_at_the_borders_of_steps(skus: SkuSet):
    """Short steps of 0 and of 2: nothing comes in the former, and no gap reaches across."""
    steps = {"kind": "steps", "cycle_s": 20, "weights": [1, 0]}
    come = times_s(orders(skus, orders_per_h=100, profile=steps))
    phase = come % 20
    assert phase.max() < 10
    assert stats.kstest(phase, stats.uniform(0, 10).cdf).pvalue > SIGNIFICANT
    assert usual(len(come), 9600)


def test_profiles_follow_the_clock_of_the_scenario(skus: SkuSet):
    steps = {"kind": "steps", "weights": [1, 0]}
    given = scenario(DAY_S, time_of_day_s=5 * 3600, demand={"mode": "poisson", "profile": steps})
    come = times_s(drive(order_intake(given, skus, SITE, 1), FakeState(), DAY_US)) / 3600
    assert not ((come > 7) & (come < 19)).any()
    assert come.max() > 23


def test_nothing_comes_in_down_periods(skus: SkuSet):
    down = {"periods_s": [[0, 21600], [79200, 86400]]}
    come = times_s(orders(skus, orders_per_h=50, down=down)) / 3600
    assert come.min() >= 6
    assert come.max() < 22
    always = times_s(orders(skus, orders_per_h=50)) / 3600
    assert set(come) == {time for time in always if 6 <= time < 22}


def test_high_and_low_periods(skus: SkuSet):
    """The rate is always one of the two; its mean follows from the time spent in each state."""
    profile = {"kind": "high-low", "high_per_h": 75}
    config = HighLowRate.model_validate(profile)
    rate = rate_of(config, 25.0, 4.0, 0.0, seed=2)
    grid_us = np.arange(0, 40 * DAY_US, US_PER_H // 60)
    rates = np.array([rate.per_h(int(time_us)) for time_us in grid_us])
    assert set(rates.tolist()) == {100.0, 300.0}
    assert rates[0] == 100.0
    edges = np.flatnonzero(np.diff(rates)) / 60
    lengths = np.diff(edges)
    low, high = lengths[1::2], lengths[0::2]
    assert low.mean() == pytest.approx(2.0, rel=0.2)
    assert high.mean() == pytest.approx(0.5, rel=0.2)
    come = times_s(orders(skus, orders_per_h=25, duration_s=5 * DAY_S, profile=profile))
    expected = rates[: 5 * 24 * 60].sum() / 60
    assert usual(len(come), expected)


def test_lengths_of_periods_are_exponential():
    config = HighLowRate(high_per_h=1.0, low_to_high_per_h=30.0, high_to_low_per_h=60.0)
    rate = rate_of(config, 0.5, 1.0, 0.0, seed=1)
    rate.per_h(30 * DAY_US)
    lengths = np.diff(rate._switches_us, prepend=0) / US_PER_H
    assert stats.kstest(lengths[0::2], stats.expon(scale=1 / 30).cdf).pvalue > SIGNIFICANT
    assert stats.kstest(lengths[1::2], stats.expon(scale=1 / 60).cdf).pvalue > SIGNIFICANT


def test_orders_and_bundles_share_their_high_periods(skus: SkuSet):
    profile = {"kind": "high-low", "high_per_h": 200}
    in_high = [
        np.histogram(times_s(come), bins=np.arange(0, 5 * DAY_S + 1, 1800))[0]
        for come in (
            orders(skus, duration_s=5 * DAY_S, orders_per_h=1, profile=profile),
            bundles(skus, duration_s=5 * DAY_S, bundles_per_h=1, profile=profile),
        )
    ]
    assert np.corrcoef(*in_high)[0, 1] > 0.95


def test_tied_rates_thin_the_stream_and_leave_the_rest_as_it_is(skus: SkuSet):
    tied = {"orders_per_h": 100, "tied_to": "pick-stations"}
    runs = [orders(skus, state=FakeState(active_pick_share=s), **tied) for s in (1.0, 0.5, 0.25)]
    assert runs[0] == orders(skus, orders_per_h=100)
    for more, fewer in pairwise(runs):
        # the same orders, some of which do not come
        assert set(fewer) < set(more)
        assert stats.binomtest(len(fewer), len(more), 0.5).pvalue > SIGNIFICANT
    gaps = np.diff(times_s(runs[1]), prepend=0)
    assert stats.kstest(gaps, stats.expon(scale=18.0).cdf).pvalue > SIGNIFICANT
    other = FakeState(active_pick_share=0.5, active_replenishment_share=1.0)
    crossed = {"orders_per_h": 100, "tied_to": "replenishment-stations"}
    assert orders(skus, state=other, **crossed) == runs[0]


def test_a_faster_process_brings_the_same_orders_sooner(skus: SkuSet):
    slow, fast = orders(skus, orders_per_h=40), orders(skus, orders_per_h=80)
    assert [order.skus for order in fast[: len(slow)]] == [order.skus for order in slow]
    assert times_s(fast[: len(slow)]) * 2 == pytest.approx(times_s(slow), abs=0.01)


def test_contents_are_those_of_the_backlog_with_plenty_in_stock(skus: SkuSet):
    given = scenario(DAY_S)
    source = OrderSource(given.orders, skus, 2)
    plenty = np.full(len(skus), 10**6)
    for k, order in enumerate(orders(skus, orders_per_h=20)):
        content = source.draw(k, plenty)
        assert (order.skus, order.units, order.redraws) == (content.skus, content.units, 0)
        assert order.due_us - order.time_us == content.due_offset_s * 1e6


def test_stock_does_not_matter(skus: SkuSet):
    empty = FakeState(uncommitted=np.zeros(1000, np.int64), waiting_orders=99, stored_space=0.0)
    assert orders(skus, state=empty) == orders(skus)


def test_initial_orders_and_bundles_wait_at_time_zero(skus: SkuSet):
    come = orders(skus, initial_orders=30)
    assert (times_s(come)[:30] == 0).all()
    assert come[30:] == orders(skus)
    more = orders(skus, initial_orders=40)
    assert more[:30] == come[:30]
    assert (times_s(bundles(skus, initial_bundles=7))[:7] == 0).all()


def test_arrivals_end_with_the_run(skus: SkuSet):
    given = scenario(600.0, demand={"mode": "poisson"})
    intake = order_intake(given, skus, SITE, 1)
    come = drive(intake, FakeState(), 10 * DAY_US)
    assert intake.next_us == NEVER_US
    assert times_s(come).max() <= 600
    longer = scenario(900.0, demand={"mode": "poisson"})
    assert drive(order_intake(longer, skus, SITE, 1), FakeState(), DAY_US)[: len(come)] == come


def test_affinity_to_nobody_left_falls_back_to_popularity():
    """The SKU before is related to one other, which is in the order already."""
    given = scenario(
        skus={"count": 5, "affinity": {"share": 1.0, "pairs": 1, "default_weight": 0.0}},
        orders={"lines": {"mean": 4, "sd": 0, "min": 4, "max": 4}},
        demand={"mode": "poisson", "initial_orders": 200},
    )
    come = drive(order_intake(given, sku_set(given.skus), SITE, 1), FakeState(5), 0)
    assert len(come) == 200
    assert all(len(set(order.skus)) == 4 for order in come)


def test_a_rate_without_end_is_refused(skus: SkuSet):
    steps = {"kind": "steps", "weights": [1, 0], "starts_s": [0, 1e-6]}
    with pytest.raises(InputError, match="per h is too high"):
        orders(skus, profile=steps)
    with pytest.raises(InputError, match="at most 1e"):
        orders(skus, orders_per_h=1e15)


def test_no_stations_no_arrivals(skus: SkuSet):
    nowhere = Site(0, 0, capacity=0.0, largest_pod=0.0)
    given = scenario(demand={"mode": "poisson", "initial_orders": 0})
    assert order_intake(given, skus, nowhere, 1).next_us == NEVER_US


def test_the_first_day_is_the_same_on_every_machine(skus: SkuSet):
    steps, high_low = {"kind": "steps"}, {"kind": "high-low", "high_per_h": 99}
    come = [
        *orders(skus, orders_per_h=30, profile=steps),
        *orders(skus, orders_per_h=30, profile=high_low, tied_to="pick-stations"),
        *bundles(skus, bundles_per_h=30, return_share=0.3),
    ]
    text = repr([tuple(thing)[: thing._fields.index("in_file")] for thing in come])
    assert hashlib.sha256(text.encode()).hexdigest() == FIRST_DAY


FIRST_DAY = "e0cbb876a8e2b792c6fa04fd8299df4e0bef528b1386511876788400628cc51c"
