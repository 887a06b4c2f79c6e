"""SKU sets: what is drawn, and that it is the same everywhere."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from rmfs.errors import InputError
from rmfs.scenario import SkuSet, draw_sku_set, exact, sku_set
from rmfs.scenario.counts import NormalCount
from rmfs.scenario.distributions import Constant, Exponential, Gamma, Normal, Uniform
from rmfs.scenario.parameters import GeneratedSkus


@pytest.mark.parametrize(
    ("popularity", "reference"),
    [
        (Gamma(shape=1.0, scale=2.0, min=1.0), stats.expon(1.0, 2.0)),
        (Exponential(rate=1.5), stats.expon(0.0, 1 / 1.5)),
        (Uniform(min=1.0, max=100.0), stats.uniform(1.0, 99.0)),
        (Normal(mean=1.0, sd=3.0, min=1.0), stats.truncnorm(0.0, np.inf, 1.0, 3.0)),
    ],
)
def test_popularity_follows_its_distribution(popularity, reference):
    skus = draw_sku_set(GeneratedSkus(count=5000, popularity=popularity), seed=3)
    assert stats.kstest(skus.popularity, reference.cdf).pvalue > 0.01


def test_space_and_bundle_sizes_follow_their_distributions():
    config = GeneratedSkus(
        count=5000,
        space_per_unit=Normal(mean=2.0, sd=1.0, min=2.0, max=8.0),
        bundle_units=NormalCount(mean=8.0, sd=2.0, min=4, max=12),
    )
    skus = sku_set(config)
    assert stats.kstest(skus.space_per_unit, stats.truncnorm(0, 6, 2, 1).cdf).pvalue > 0.01
    expected = config.bundle_units.probabilities() * 5000
    assert stats.chisquare(np.bincount(skus.bundle_units)[4:], expected).pvalue > 0.01


def test_constant_popularity_makes_all_skus_alike():
    skus = sku_set(GeneratedSkus(count=8, popularity=Constant()))
    assert skus.by_popularity.probabilities == pytest.approx(np.full(8, 1 / 8))


def test_skus_depend_on_their_own_seed_only(skus: SkuSet):
    assert sku_set(GeneratedSkus()).digest() == skus.digest()
    assert sku_set(GeneratedSkus(seed=1)).digest() != skus.digest()


def test_a_distribution_of_one_property_leaves_the_others_alone(skus: SkuSet):
    other = sku_set(GeneratedSkus(popularity=Constant()))
    assert (other.space_per_unit == skus.space_per_unit).all()
    assert (other.bundle_units == skus.bundle_units).all()


def test_the_default_skus_are_the_same_on_every_machine(skus: SkuSet):
    assert skus.digest() == DEFAULT_SKUS


def test_sums_of_spaces_are_exact_in_any_order(skus: SkuSet):
    chosen = np.random.default_rng(1).integers(len(skus), size=10_000)
    spaces = skus.bundle_space[chosen].tolist()
    assert sum(spaces) == sum(sorted(spaces)) == sum(reversed(spaces))
    used = sum(spaces)
    for space in spaces:
        used -= space
    assert used == 0.0


def test_space_is_cut_not_rounded():
    assert exact.space(np.array([0.1]))[0] * 10 <= 1.0
    assert exact.space(np.array([1e-12]))[0] > 0
    assert exact.space(np.array([2.5]))[0] == 2.5


def test_nine_digits_remain():
    values = np.array([1 / 3, 1e-20 / 3, 12345.678901, 0.0])
    assert exact.significant(values) == pytest.approx(values, rel=1e-9)
    assert (
        exact.significant(np.nextafter(values, np.inf))[:3] == exact.significant(values)[:3]
    ).all()


def test_a_bundle_larger_than_a_pod_is_refused(few_skus: SkuSet):
    few_skus.check_fit(20.0)
    with pytest.raises(InputError, match=r"demo: bundles of 2 SKUs .* 4 units of SKU 4 take 20"):
        few_skus.check_fit(15.0, source="demo")


def test_arrays_cannot_be_written(skus: SkuSet):
    with pytest.raises(ValueError, match="read-only"):
        skus.popularity[0] = 1.0


def test_arrays_of_different_length_are_refused():
    with pytest.raises(ValueError, match="same length"):
        SkuSet(np.arange(3), np.ones(3), np.ones(2), np.ones(3, dtype=np.int64))


DEFAULT_SKUS = "a153534225d27bdcb09d8a3b24cf5cc763c9c68558fb698d4d8eb6924580643f"
