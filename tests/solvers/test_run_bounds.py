"""The bound on whole runs: what is put in, and that runs of many kinds stay below it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bounds import Counter
from doubles import KIND, FreeTraffic, small_layout, small_skus

import rmfs
from rmfs import layout as layouts
from rmfs.measure.bound import BoundExceededWarning, units_per_h_bound, warn_if_exceeded
from rmfs.simulation.kernel import Kernel
from rmfs.solvers.models.run_bound import Throughput, solve, violations
from rmfs.solvers.run_bound import run_bound, units_per_h_keeping_stock
from rmfs.traffic import Traffic

HOUR_S = 3600.0


def test_the_input_is_what_layout_and_skus_allow():
    """Places on y = 0, x = 0 ... 5; the pick station at (0, 10), the other one at (5, 10)."""
    layout = small_layout(pod_capacity=100.0, slots=4)
    data = run_bound(layout, small_skus(space=3.0), FreeTraffic(layout), HOUR_S)
    picking, refill = data.picking, data.refill
    assert (picking.unit_transfer_s.tolist(), picking.unit_pick_s.tolist()) == ([10.0], [3.0])
    assert picking.order_slots.tolist() == [4]
    # 10 m from the nearest place, 5 m from the other station, 2 s to lift
    assert picking.inbound_s == pytest.approx([5 / 2], rel=1e-5)
    assert picking.outbound_s == pytest.approx([5 / 2], rel=1e-5)
    far = replace(layout, replenishment_stations=())
    alone = run_bound(far, small_skus(space=3.0), FreeTraffic(far), HOUR_S)
    assert alone.picking.inbound_s == pytest.approx([12.0], rel=1e-5)
    assert data.stock.pod_units.tolist() == [33] * 4
    assert (refill.bundle_units, refill.bundles_per_visit) == (33, 33)
    assert (data.robots, data.duration_s) == (2, HOUR_S)


def test_the_fastest_kind_of_robot_counts():
    plan = layouts.load("basic")
    slow = replace(plan.robot_kinds[0], top_speed_m_s=0.3, pod_transfer_s=9.0)
    mixed = replace(
        plan, robot_kinds=(slow, *plan.robot_kinds), robot_kind=np.arange(plan.robots) % 2
    )
    mixed = replace(mixed, robot_kind=mixed.robot_kind.astype(np.int16))
    one, both = (
        run_bound(each, small_skus(), Traffic(each), HOUR_S).picking for each in (plan, mixed)
    )
    assert both.inbound_s == pytest.approx(one.inbound_s)
    assert both.changeover_s == pytest.approx(one.changeover_s)


def test_handling_without_time_has_no_bound():
    layout = small_layout(unit_transfer_s=0.0, unit_pick_s=0.0)
    skus = small_skus()
    assert units_per_h_bound(layout, skus, FreeTraffic(layout), HOUR_S) == float("inf")


def test_rmfs_finds_the_bound_without_importing_solvers():
    layout = small_layout()
    found = units_per_h_bound(layout, small_skus(), FreeTraffic(layout), HOUR_S)
    assert found == solve(run_bound(layout, small_skus(), FreeTraffic(layout), HOUR_S)).bound
    # the station alone: a pick every 10 s, and one that ends later
    assert found == pytest.approx(361.0)


def test_the_bound_of_fleets_that_keep_their_stock_knows_bundles():
    layout, skus = small_layout(robots=5), small_skus(bundle_units=4)
    times = FreeTraffic(layout)
    found = units_per_h_keeping_stock(layout, skus, times, HOUR_S, [1, 2, 3])
    assert list(found) == [1, 2, 3]
    # least for a unit: a visit of its own, 5 s of ways and 3 s, not 10 s at the head; a quarter of
    # the 10 s of a bundle; and a hundredth of a visit that fills a pod
    assert found[1] == pytest.approx(3600 / (8 + 10 / 4 + 5 / 100), rel=0.01)
    assert found[1] < found[2] == found[3] == units_per_h_bound(layout, skus, times, HOUR_S)
    larger = units_per_h_keeping_stock(layout, small_skus(bundle_units=8), times, HOUR_S, [1])
    assert larger[1] > found[1]


@pytest.mark.parametrize(
    ("robots", "transfer_s", "pick_s"),
    [(1, 10.0, 3.0), (2, 2.0, 2.0), (6, 1.0, 4.0), (24, 10.0, 3.0), (24, 0.5, 0.25)],
)
def test_runs_in_which_each_resource_is_scarce_in_turn(robots, transfer_s, pick_s):
    """`tests/bounds.py` puts the counts of each into all inequalities."""
    plan = layouts.load("basic", [(["robots"], robots)])
    fast = tuple(
        replace(station, unit_transfer_s=transfer_s, unit_pick_s=pick_s)
        for station in plan.pick_stations
    )
    overrides = [(["scenario", "duration_s"], 1200.0), (["scenario", "warmup_s"], 300.0)]
    run = rmfs.simulate(
        replace(plan, pick_stations=fast), "basic", "default", seed=1, overrides=overrides
    )
    assert 0.0 < run.footprint["units_score"] <= 1.0


def test_a_run_that_did_the_impossible_is_noticed():
    layout = small_layout()
    data = run_bound(layout, small_skus(), FreeTraffic(layout), HOUR_S)
    none = np.zeros(1)
    for units, visits, possible in (
        (361, 10, True),
        (362, 10, False),  # faster than the station
        (361, 3, False),  # more from each visit than a pod holds
        (9, 10, False),  # visits without a unit
    ):
        counts = Throughput(np.array([units]), np.array([visits]), np.array([units]), none, none)
        assert (not violations(data, counts)) is possible, (units, visits)
    assert KIND.pod_transfer_s == 2.0
    with pytest.warns(BoundExceededWarning, match="362"):
        warn_if_exceeded(362.0, 361.0)


def test_every_simulation_of_the_tests_is_counted():
    from rmfs import control, scenario

    work = scenario.load("basic", [(["duration_s"], 60.0)])
    built = Kernel(layouts.load("basic"), work, control.load("default"))
    assert any(isinstance(one, Counter) for one in built.events._observers)
