"""Layers of pods: no unit is lost, none lies where there is no room."""

from __future__ import annotations

import numpy as np
import pytest

from rmfs.scenario.parameters.pickers import Layers
from rmfs.world.pod_layers import PodLayers

TIMES = (1.2, 1.0, 0.8)


def pods(storing="emptiest", space=(2.0, 3.0, 5.0), popularity=(1.0, 9.0, 4.0), capacity=60.0):
    given = Layers(time_factors=TIMES, storing=storing)
    return PodLayers(given, np.array(space), np.array(popularity), np.array([capacity, 9.0]))


def test_the_emptiest_layer_first():
    made = pods()
    made.put(0, 0, 3)
    made.put(0, 1, 2)
    made.put(0, 2, 1)
    assert made.used[0].tolist() == [6.0, 6.0, 5.0]
    assert [made.take(0, sku) for sku in (0, 1, 2)] == [0, 1, 2]


def test_the_golden_zone_first_and_what_does_not_fit_beside():
    made = pods("golden")
    made.put(0, 2, 5)  # 20 of space in each layer: four fit
    assert made.used[0].tolist() == [0.0, 5.0, 20.0]
    assert [made.take(0, 2) for _ in range(5)] == [2, 2, 2, 2, 1]
    assert made.units(0, 2) == 0


def test_popular_skus_lie_in_fast_layers():
    made = pods("popular")
    for sku in range(3):
        made.put(0, sku, 1)
    assert [made.take(0, sku) for sku in (1, 2, 0)] == [2, 1, 0]


def test_what_fits_into_no_layer_is_stored_all_the_same():
    made = pods()
    made.put(1, 2, 1)  # 5 of space, where each layer has 3 of 9
    assert made.units(1, 2) == 1
    assert made.take(1, 2) == 0


@pytest.mark.parametrize("storing", ["emptiest", "golden", "popular"])
def test_no_unit_is_lost(storing):
    rng = np.random.default_rng(5)
    space = rng.integers(1, 6, 12) / 2
    made = pods(storing, space, rng.random(12), capacity=40.0)
    held = np.zeros(12, int)
    for _ in range(3000):
        sku = int(rng.integers(12))
        units = int(rng.integers(1, 5))
        if rng.random() < 0.5 and held @ space + units * space[sku] <= 40.0:
            made.put(0, sku, units)
            held[sku] += units
        elif held[sku]:
            assert 0 <= made.take(0, sku) < 3
            held[sku] -= 1
        assert made.used[0].sum() == pytest.approx(held @ space)
        assert made.used.min() >= 0
    assert [made.units(0, sku) for sku in range(12)] == held.tolist()
