"""Warm-up proposals against hand-worked examples and series whose settling time is known."""

from __future__ import annotations

import numpy as np
import pytest

from rmfs.measure.warmup import mser, settled, welch


def test_mser_on_paper():
    # means 10, 1, 2, 1, 2: var / n of the rest is 11.76/5, 0.25/4 = 0.0625, 0.222/3 = 0.074
    assert mser([10, 1, 2, 1, 2], batch=1) == 1
    assert mser(np.repeat([10, 1, 2, 1, 2], 5)) == 5


def test_mser_of_a_flat_series_drops_nothing():
    assert mser(np.full(40, 3.0)) == 0


def test_mser_finds_the_end_of_a_ramp():
    noise = np.random.default_rng(1).normal(0, 0.02, 400)
    dropped = mser(np.minimum(np.arange(400) / 100, 1.0) + noise)
    assert dropped is not None
    assert 80 <= dropped <= 105


def test_mser_says_when_a_series_is_too_short_or_never_settles():
    assert mser(np.arange(15.0)) is None
    assert mser(np.arange(400.0)) is None


def test_welch_on_paper():
    smooth = welch([1, 2, 6, 3, 4, 8], 1)
    assert smooth.tolist() == pytest.approx([1, 3, 11 / 3, 13 / 3, 5])
    # near the beginning the window shrinks: 0, then 1, then 2 on either side
    assert welch([1, 2, 6, 3, 4, 8], 2).tolist() == pytest.approx([1, 3, 16 / 5, 23 / 5])


@pytest.mark.parametrize("window", [0, 4])
def test_welch_refuses_windows_that_do_not_fit(window):
    with pytest.raises(ValueError, match="half of 6"):
        welch([1, 2, 3, 4, 5, 6], window)


def test_settled():
    assert settled([0, 5, 9, 10, 10, 10, 10, 10]) == 3
    assert settled([10, 10, 10, 10]) == 0
    assert settled([0, 10, 10, 10, 10, 20]) is None
