"""Distributions of what is drawn in several steps, against what the steps say together.

The distributions themselves, arrivals, stock, SKU sets and words have tests of their own; the page
docs/scenarios.md lists them all.
"""

from __future__ import annotations

import numpy as np
import pytest
from scenario_tools import SIGNIFICANT, SITE, FakeState, drive, scenario, times_s
from scipy import stats

from rmfs.scenario import BundleSource, OrderSource, SkuSet, bundle_intake, order_intake, sku_set
from rmfs.scenario.clock import US_PER_H, US_PER_S
from rmfs.scenario.counts import NormalCount
from rmfs.scenario.intake.rates import rate_of
from rmfs.scenario.parameters import Orders
from rmfs.scenario.parameters.rates import HighLowRate
from rmfs.scenario.skus.affinity import Affinity

DAY_S = 86_400.0
PLENTY = np.full(4, 10**6)
POPULARITY = np.array([4.0, 3.0, 2.0, 1.0])


def related(share: float) -> SkuSet:
    """Four SKUs: 0 and 1 go together, and 0 and 2 less so; all other pairs hardly do."""
    return SkuSet(
        ids=np.arange(4),
        popularity=POPULARITY,
        space_per_unit=np.ones(4),
        bundle_units=np.full(4, 4),
        affinity=Affinity(
            first=np.array([0, 1, 0, 2]),
            second=np.array([1, 0, 2, 0]),
            weight=np.array([5.0, 5.0, 2.0, 2.0]),
            default_weight=0.5,
            share=share,
        ),
    )


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_second_line_is_drawn_by_affinity_or_popularity(share):
    """Given the first, in the share that is said; never the same SKU again."""
    two = NormalCount(mean=2.0, sd=0.0, min=2, max=2)
    source = OrderSource(Orders(lines=two), related(share), seed=2)
    pairs = np.zeros((4, 4))
    for k in range(8_000):
        first, second = source.draw(k, PLENTY).skus
        pairs[first, second] += 1
    weight = np.full((4, 4), 0.5)
    weight[0, 1] = weight[1, 0] = 5.0
    weight[0, 2] = weight[2, 0] = 2.0
    assert stats.chisquare(pairs.sum(axis=1), POPULARITY / 10 * 8_000).pvalue > SIGNIFICANT
    statistic = 0.0
    for first in range(4):
        others = np.arange(4) != first
        by_affinity = weight[first, others] / weight[first, others].sum()
        by_popularity = POPULARITY[others] / POPULARITY[others].sum()
        expected = share * by_affinity + (1 - share) * by_popularity
        counts = pairs[first, others]
        statistic += stats.chisquare(counts, expected * counts.sum()).statistic
    assert statistic < stats.chi2(4 * 2).isf(SIGNIFICANT)


def test_returns_are_a_share_of_the_bundles_and_of_any_sku():
    skus = related(0.0)
    source = BundleSource(skus, 5, return_share=0.3)
    drawn = [source.draw(k) for k in range(10_000)]
    returned = np.array([bundle.units == 1 for bundle in drawn])
    assert stats.binomtest(int(returned.sum()), 10_000, 0.3).pvalue > SIGNIFICANT
    of_sku = np.bincount([bundle.sku for bundle in drawn], weights=returned, minlength=4)
    assert stats.chisquare(of_sku, POPULARITY / 10 * returned.sum()).pvalue > SIGNIFICANT


def test_units_of_a_letter(tmp_path):
    words = tmp_path / "words.txt"
    words.write_text("x\n")
    units = {"distribution": "normal", "mean": 1.5, "sd": 1.0, "min": 1, "max": 4}
    given = scenario(
        skus={"words": str(words), "colours": {"red": 1}},
        orders={"content": "words", "units_per_letter": units},
        demand={"mode": "poisson", "initial_orders": 5000},
    )
    come = drive(order_intake(given, sku_set(given.skus), SITE, 1), FakeState(1), 0)
    counts = np.bincount([order.units[0] for order in come])[1:]
    borders = np.array([-np.inf, 1.5, 2.5, 3.5, 4.5])
    cut = stats.truncnorm(-1.0, 3.0, loc=1.5, scale=1.0)
    expected = np.diff(cut.cdf(borders)) * 5000
    assert stats.chisquare(counts, expected).pvalue > SIGNIFICANT


@pytest.mark.parametrize(
    ("due", "cdf"),
    [
        ({"mode": "normal", "mean_s": 5000, "sd_s": 2000, "min_s": 1000, "max_s": 8000},
         stats.truncnorm(-2.0, 1.5, loc=5000, scale=2000).cdf),
    ],
)  # fmt: skip
def test_due_times_of_orders(due, cdf, skus: SkuSet):
    given = scenario(orders={"due": due}, demand={"mode": "poisson", "initial_orders": 5000})
    come = drive(order_intake(given, skus, SITE, 2), FakeState(), 0)
    assert len(come) >= 5000
    assert stats.kstest([order.due_s for order in come[:5000]], cdf).pvalue > SIGNIFICANT


@pytest.mark.parametrize("what", ["orders", "bundles"])
def test_arrivals_in_high_and_low_periods_follow_the_integral_of_the_rate(what, skus: SkuSet):
    """Given the periods drawn, the arrivals are those of an inhomogeneous Poisson process."""
    profile = {"kind": "high-low", "high_per_h": 90}
    word, make = ("demand", order_intake) if what == "orders" else ("replenishment", bundle_intake)
    table = {"mode": "poisson", f"{what}_per_h": 20, "profile": profile, "per_station": False}
    given = scenario(5 * DAY_S, **{word: {**table, f"initial_{what}": 0}})
    come = times_s(drive(make(given, skus, SITE, 4), FakeState(), round(5 * DAY_S) * US_PER_S))
    rate = rate_of(HighLowRate.model_validate(profile), 20.0, 1.0, 0.0, 4)
    grid_us = np.arange(0, int(5 * DAY_S) + 1, 10) * US_PER_S
    per_h = np.array([rate.per_h(int(time_us)) for time_us in grid_us])
    integral = np.concatenate([[0.0], np.cumsum(per_h[:-1] * np.diff(grid_us) / US_PER_H)])
    assert {20.0, 90.0} == set(per_h.tolist())
    assert abs(len(come) - integral[-1]) < 4 * np.sqrt(integral[-1])
    share = np.interp(come, grid_us / US_PER_S, integral / integral[-1])
    assert stats.kstest(share, "uniform").pvalue > SIGNIFICANT
