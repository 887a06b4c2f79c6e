"""Little's law on pick stations: orders open, and waiting, are their rate times their time.

Both sides come from different columns. In a finite run they differ by what is there at its ends, so
that means over seeds agree within their interval.
"""

from __future__ import annotations

import numpy as np
import pytest

import rmfs
from rmfs.experiments.statistics import interval
from rmfs.measure.steps import Steps

BEGIN, END = 1200.0, 4800.0
GIVEN = {
    "layout.robots": 8,
    "scenario.warmup_s": BEGIN,
    "scenario.duration_s": END - BEGIN,
    "scenario.demand.orders_per_h": 180.0,
    "scenario.demand.initial_orders": 10,
    "scenario.stock.initial_share": 0.8,
    "scenario.replenishment": {"mode": "needed", "reorder_below_units": 15},
}
SEEDS = range(8)


@pytest.fixture(scope="module")
def runs():
    return [
        rmfs.simulate("small", "small-arrivals", "default", seed=seed, set=GIVEN) for seed in SEEDS
    ]


def agrees(differences: list[float], scale: float) -> None:
    """Check that a mean difference is 0 within its interval, which is narrow."""
    found = interval(differences, 0.99)
    assert found.low <= 0.0 <= found.high
    assert found.half_width < 0.25 * scale


@pytest.mark.parametrize("station", [0, 1])
def test_orders_at_a_station(runs, station):
    number, product = [], []
    for run in runs:
        orders = run.table("orders")
        own = orders[orders["station"] == station]
        open_ones = Steps.between(own["assigned_s"], own["completed_s"]).mean(BEGIN, END)
        done = own[own["completed_s"].notna()]
        rate = len(done) / (END - BEGIN)
        number.append(open_ones)
        product.append(rate * float((done["completed_s"] - done["assigned_s"]).mean()))
    agrees(list(np.subtract(number, product)), float(np.mean(number)))


def test_all_orders_of_the_footprint(runs):
    """`open_orders_mean` counts over time, the rate and the time count completed orders."""
    prints = [run.footprint for run in runs]
    number = [float(one["open_orders_mean"]) for one in prints]
    product = [
        float(one["orders_per_h"]) / 3600.0 * float(one["order_throughput_time_mean_s"])
        for one in prints
    ]
    agrees(list(np.subtract(number, product)), float(np.mean(number)))


def test_a_picker_is_busy_for_units_times_their_time(runs):
    """The same law for the place of the picker alone."""
    for run in runs:
        stations = run.table("stations")
        own = stations[stations["kind"] == "pick"]
        unit_s = np.array([one.unit_transfer_s for one in run.layout.pick_stations])
        # a unit at each end of the time may be counted in part
        assert own["busy_s"].to_numpy() == pytest.approx(own["units_picked"] * unit_s, abs=10.0)
