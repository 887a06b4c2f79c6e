"""Every distribution against scipy's, or against redrawing."""

from __future__ import annotations

import numpy as np
import pydantic
import pytest
from scipy import stats

from rmfs.scenario.counts import NormalCount, UniformCount
from rmfs.scenario.distributions import Constant, Exponential, Gamma, Normal, Uniform
from rmfs.scenario.due import NormalDue, PriorityDue

SIGNIFICANT = 0.01
"""Seeds are fixed: a test that once passes this level always does."""

CUTS = [(0.0, None), (1.0, None), (0.5, 3.0), (0.0, 2.0)]
SHAPES = [
    (Gamma(shape=1.0, scale=2.0), stats.gamma(1.0, scale=2.0)),
    (Gamma(shape=0.4, scale=3.0), stats.gamma(0.4, scale=3.0)),
    (Gamma(shape=5.0, scale=0.5), stats.gamma(5.0, scale=0.5)),
    (Exponential(rate=1.5), stats.expon(scale=1 / 1.5)),
    (Normal(mean=1.0, sd=3.0), stats.norm(1.0, 3.0)),
    (Normal(mean=-2.0, sd=1.0), stats.norm(-2.0, 1.0)),
]


def uniform(n: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).random(n)


@pytest.mark.parametrize(("low", "high"), CUTS)
@pytest.mark.parametrize(("distribution", "reference"), SHAPES)
def test_a_cut_distribution_is_the_conditional_one(distribution, reference, low, high):
    cut = distribution.model_copy(update={"min": low, "max": high})
    values = cut.quantile(uniform(5000))
    top = np.inf if high is None else high
    assert values.min() >= low
    assert values.max() <= top
    below, above = reference.cdf(low), reference.cdf(top)
    test = stats.kstest(values, lambda x: (reference.cdf(x) - below) / (above - below))
    assert test.pvalue > SIGNIFICANT


def test_a_normal_far_in_its_tail_keeps_its_digits():
    cut = Normal(mean=0.0, sd=1.0, min=5.0, max=6.0)
    test = stats.kstest(cut.quantile(uniform(5000)), stats.truncnorm(5.0, 6.0).cdf)
    assert test.pvalue > SIGNIFICANT


def test_constant_and_uniform():
    assert (Constant(value=3.0).quantile(uniform(10)) == 3.0).all()
    values = Uniform(min=2.0, max=8.0).quantile(uniform(5000))
    assert stats.kstest(values, stats.uniform(2.0, 6.0).cdf).pvalue > SIGNIFICANT
    assert (Uniform(min=2.0, max=2.0).quantile(uniform(10)) == 2.0).all()


@pytest.mark.parametrize(
    ("mean", "sd", "low", "high"),
    [(1.0, 1.0, 1, 4), (1.0, 0.3, 1, 3), (8.0, 2.0, 4, 12), (0.0, 5.0, 1, 30)],
)
def test_counts_are_what_redrawing_and_rounding_gives(mean, sd, low, high):
    counts = NormalCount(mean=mean, sd=sd, min=low, max=high)
    draw = counts.sampler()
    drawn = np.array([draw(u) for u in uniform(20_000)])
    redrawn = np.random.default_rng(2).normal(mean, sd, 400_000)
    redrawn = np.floor(redrawn[(redrawn >= low - 0.5) & (redrawn < high + 0.5)] + 0.5)
    values = np.arange(low, high + 1)
    expected = np.array([(redrawn == value).mean() for value in values])
    assert counts.probabilities() == pytest.approx(expected, abs=0.005)
    observed = np.array([(drawn == value).sum() for value in values])
    often = len(drawn) * counts.probabilities() > 5
    expected = counts.probabilities()[often]
    observed = observed[often]
    test = stats.chisquare(observed, expected / expected.sum() * observed.sum())
    assert test.pvalue > SIGNIFICANT


def test_counts_without_spread_are_the_rounded_mean():
    draw = NormalCount(mean=2.5, sd=0.0, min=1, max=5).sampler()
    assert {draw(u) for u in uniform(100)} == {3}


def test_counts_far_above_the_mean_keep_their_digits():
    counts = NormalCount(mean=0.0, sd=1.0, min=5, max=7)
    edges = stats.norm.sf(np.arange(4.5, 8.0))
    expected = (edges[:-1] - edges[1:]) / (edges[0] - edges[-1])
    assert counts.probabilities() == pytest.approx(expected, rel=1e-9)


def test_uniform_counts_include_both_ends():
    draw = UniformCount(min=4, max=12).sampler()
    drawn = np.array([draw(u) for u in uniform(9000)])
    assert stats.chisquare(np.bincount(drawn)[4:]).pvalue > SIGNIFICANT
    assert set(drawn.tolist()) == set(range(4, 13))


def test_due_times_of_two_classes():
    draw = PriorityDue().sampler()
    offsets = np.array([draw(u) for u in uniform(10_000)])
    assert set(offsets.tolist()) == {1800.0, 7200.0}
    assert stats.binomtest(int((offsets == 1800).sum()), 10_000, 0.2).pvalue > SIGNIFICANT


def test_normal_due_times():
    draw = NormalDue().sampler()
    offsets = np.array([draw(u) for u in uniform(5000)])
    cut = stats.truncnorm(-4.0, 4.0, loc=10800, scale=900)
    assert stats.kstest(offsets, cut.cdf).pvalue > SIGNIFICANT
    assert (offsets == np.round(offsets, 3)).all()


@pytest.mark.parametrize(
    "make",
    [
        lambda: Gamma(shape=1.0, scale=1.0, min=800.0),
        lambda: Normal(mean=-100.0, sd=1.0),
        lambda: Exponential(rate=1.0, min=3.0, max=2.0),
        lambda: Uniform(min=3.0, max=2.0),
        lambda: Uniform(min=0.0, max=2.0),
        lambda: NormalCount(mean=1.0, sd=0.0, min=2, max=4),
        lambda: NormalCount(mean=1.0, sd=-1.0, min=1, max=4),
        lambda: UniformCount(min=0, max=4),
        lambda: NormalDue(min_s=100.0, max_s=50.0),
    ],
)
def test_impossible_parameters_are_refused(make):
    with pytest.raises(pydantic.ValidationError):
        make()
