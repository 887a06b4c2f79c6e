"""Draws by integer weights."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from rmfs.scenario.categorical import SCALE, Categorical


def test_frequencies_follow_the_weights():
    weights = np.array([5.0, 0.0, 1.0, 3.0, 1.0])
    sampler = Categorical(weights)
    drawn = [sampler.pick(u) for u in np.random.default_rng(1).random(20_000)]
    counts = np.bincount(drawn, minlength=5)
    assert counts[1] == 0
    kept = weights > 0
    expected = weights[kept] / weights.sum() * len(drawn)
    assert stats.chisquare(counts[kept], expected).pvalue > 0.01


def test_probabilities_are_the_weights_to_twelve_digits():
    weights = np.random.default_rng(1).gamma(0.3, 2.0, 100_000)
    sampler = Categorical(weights)
    assert len(sampler) == 100_000
    assert np.abs(sampler.probabilities - weights / weights.sum()).max() < 1e-12


def test_both_ends_of_the_unit_interval_are_valid():
    sampler = Categorical([0.0, 1.0, 2.0, 0.0])
    assert sampler.pick(0.0) == 1
    assert sampler.pick(np.nextafter(1.0, 0.0)) == 2


def test_a_positive_weight_never_vanishes():
    sampler = Categorical([1e-30, 1.0])
    assert sampler.pick(0.0) == 0
    assert sampler.pick(1.5 / SCALE) == 1


def test_last_bits_of_a_weight_do_not_matter():
    weights = np.random.default_rng(1).gamma(1.0, 2.0, 1000)
    uniform = np.random.default_rng(2).random(1000)
    nudged = Categorical(np.nextafter(weights, np.inf))
    picks = [Categorical(weights).pick(u) for u in uniform]
    assert [nudged.pick(u) for u in uniform] == picks


def test_renormalised_over_those_allowed():
    sampler = Categorical([4.0, 3.0, 2.0, 1.0])
    allowed = np.array([False, True, False, True])
    drawn = [sampler.pick_among(allowed, u) for u in np.random.default_rng(3).random(4000)]
    counts = np.bincount(drawn, minlength=4)
    assert counts[[0, 2]].sum() == 0
    assert stats.chisquare(counts[[1, 3]], [3000, 1000]).pvalue > 0.01


def test_nothing_allowed():
    sampler = Categorical([1.0, 0.0])
    assert sampler.pick_among(np.array([False, True]), 0.5) is None
    assert sampler.pick_among(np.array([False, False]), 0.5) is None


@pytest.mark.parametrize("weights", [[], [0.0], [-1.0, 2.0], [np.nan, 1.0], [np.inf], [[1.0]]])
def test_impossible_weights_are_refused(weights):
    with pytest.raises(ValueError, match="weights"):
        Categorical(weights)
