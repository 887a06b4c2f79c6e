"""The recorder's cost, and what it keeps."""

from __future__ import annotations

import struct
import time
from math import isnan

import pytest
from fake_run import FakeTraffic, bundle, order, recorded, simulation, world

import rmfs
from rmfs.measure import Recorder
from rmfs.measure.log import Log


def a_busy_run(callbacks: int) -> float:
    """Tell a fresh recorder so many events in the mix of a run; returns the wall time in s."""
    recorder = Recorder()
    recorder.run_started(simulation(world(), FakeTraffic()))
    rounds = callbacks // 15
    orders = [order(k, 1.0, [(0, 2), (1, 1)], station=0) for k in range(rounds)]
    bundles = [bundle(k, 1.0, station=2, pod=1) for k in range(rounds)]
    begin = time.perf_counter()
    for k in range(rounds):
        one, moment = orders[k], float(k)
        recorder.order_created(one)
        recorder.order_assigned(one)
        recorder.task_started(moment, 0, "pick", 0)
        recorder.pod_lifted(moment, 0, 0, 1)
        recorder.visit_started(moment, 0, 0, 0)
        recorder.station_busy(0, moment, moment + 1)
        recorder.unit_picked(moment, one, 0, 0, 0, 0, False)
        recorder.line_picked(moment, one, 0, 2)
        recorder.order_completed(one)
        recorder.visit_ended(moment, 0, 0, 0)
        recorder.bundle_created(bundles[k])
        recorder.bundle_assigned(bundles[k])
        recorder.bundle_stored(bundles[k], 0)
        recorder.decision("poa", moment, 0.0, 1)
        recorder.pod_set_down(moment, 0, 0, 1)
    return time.perf_counter() - begin


@pytest.mark.benchmark
def test_ten_thousand_callbacks_cost_less_than_20_ms():
    assert min(a_busy_run(10_000) for _ in range(7)) < 0.020


def test_finished_work_is_let_go():
    recorder = recorded()
    assert set(recorder.open_orders) == {2}
    assert set(recorder.open_bundles) == {1}
    assert recorder.orders.columns()["order"].tolist() == [0, 1]


def test_a_visit_at_the_end_stays_open():
    recorder = Recorder()
    recorder.run_started(simulation(world(), FakeTraffic()))
    recorder.visit_started(3.0, 0, 1, 1)
    recorder.run_ended(10.0)
    visits = {name: column.tolist() for name, column in recorder.visits.columns().items()}
    end = visits.pop("end_s")
    assert visits == {"station": [0], "pod": [1], "robot": [1], "begin_s": [3.0]}
    assert isnan(end[0])


def test_a_log_keeps_every_value_and_may_be_read_at_any_time():
    log = Log(time_s="f8", pod="i4", kind="i1", late="?")
    rows = [(0.1 * k, 10**9 + k, k % 5, k % 2 == 0) for k in range(1000)]
    for number, row in enumerate(rows):
        assert len(log) == number
        log.add(*row)
        if number % 300 == 0:
            assert len(log.columns()["pod"]) == number + 1
    told = log.columns()
    assert list(zip(*(told[name].tolist() for name in told), strict=True)) == rows
    with pytest.raises(struct.error):
        log.add(0.0, 2**31, 0, False)


def test_without_warm_up_the_first_orders_are_measured() -> None:
    """At time 0, orders are drawn until the little stock cannot serve another."""
    keys = {"scenario.stock.initial_share": 0.05, "scenario.duration_s": 10.0}
    run = rmfs.simulate("small", "small", seed=1, set=keys)
    assert run.footprint["order_redraws"] == run.world.order_redraws > 0
