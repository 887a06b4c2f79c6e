"""Our figures beside those measured on the reference system (its layouts, scenarios and rules)."""

import numpy as np
import pytest

import rmfs


def footprints(layout, scenario, controllers, seeds, **scenario_values):
    overrides = [(["scenario", key], value) for key, value in scenario_values.items()]
    return [
        rmfs.simulate(layout, scenario, controllers, seed=seed, overrides=overrides).footprint
        for seed in seeds
    ]


def mean(rows, column):
    return float(np.mean([row[column] for row in rows]))


@pytest.mark.slow
def test_path_planning_case(reference):
    """32 robots, random rules, 7200 s: the best planner there, WHCAv*, handles 997 orders."""
    layout = reference("pp/1-4-4-32-550.xinst")
    rows = footprints(layout, "pp-minimal", "random", range(10), duration_s=7200.0)
    assert mean(rows, "orders_completed") > 0.95 * 997
    assert mean(rows, "bundles_stored") > 0.95 * 2442


@pytest.mark.slow
def test_large_path_planning_case(reference):
    """128 robots, 3600 s: FARr handles 1211 orders and 1814 bundles."""
    layout = reference("pp/1-12-20-128-1965.xinst")
    rows = footprints(layout, "pp-minimal", "random", range(3), duration_s=3600.0)
    assert mean(rows, "orders_completed") > 1211
    assert mean(rows, "bundles_stored") > 1814


@pytest.mark.slow
def test_three_tiers(reference):
    """96 robots and elevators, 3600 s: FARr handles 1347 orders, WHCAn* 1962 bundles."""
    layout = reference("pp/3-12-12-96-1650.xinst")
    rows = footprints(layout, "pp-minimal", "random", range(3), duration_s=3600.0)
    assert mean(rows, "orders_completed") > 1347
    assert mean(rows, "bundles_stored") > 1962


@pytest.mark.slow
def test_regression_case(reference):
    """600 s: 64.4 orders (five seeds), 110.5 units, 104 bundles there.

    Units and bundles agree within 10 %. Orders lie above: at equal units, which orders are
    finished first after the start differs (1.3 against 1.5 units an order), and over 48 h the
    difference is gone (see the next test).
    """
    layout = reference("basic/BasicInstance.xlayo")
    rows = footprints(layout, "basic", "default", range(10))
    assert mean(rows, "units_picked") == pytest.approx(110.5, rel=0.1)
    assert mean(rows, "bundles_stored") == pytest.approx(104, rel=0.1)
    assert 0.9 * 64.4 < mean(rows, "orders_completed") < 1.3 * 64.4


@pytest.mark.slow
def test_two_days_of_the_default_rules(reference):
    """8 robots, 48 h: 23314 orders of 1.64 units, 4.17 units a visit there (one seed)."""
    layout = reference("fastlane/1-4-4-32-0.85.xlayo")
    (row,) = footprints(layout, "basic", "default", [0], duration_s=172_800.0)
    assert row["units_picked"] / row["orders_completed"] == pytest.approx(1.64, rel=0.02)
    assert 0.98 * 23314 < row["orders_completed"] < 1.1 * 23314
    assert row["units_per_visit"] == pytest.approx(4.17, rel=0.06)
