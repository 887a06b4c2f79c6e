"""Independent bookkeeping of a run, to be compared with what the world says at its end."""

from __future__ import annotations

from collections import Counter

import numpy as np

from rmfs.measure.tables.delays import PARTS, by_order
from rmfs.observer import Observer
from rmfs.world import verify


class Ledger(Observer):
    """Counts units per SKU and pod from callbacks alone."""

    def run_started(self, simulation):
        self.world = simulation.world
        self.initial = simulation.world.inventory.contained.copy()
        self.picked = np.zeros_like(self.initial)
        self.stored = np.zeros_like(self.initial)
        self.orders = {}
        self.completed = []
        self.picks = Counter()
        self.log = []

    def order_created(self, order):
        self.orders[order.index] = order

    def unit_picked(self, time_s, order, sku, pod, robot, station, late_bound):
        self.picked[sku, pod] += 1
        self.picks[order.index, sku] += 1
        self.log.append((time_s, "pick", order.index, sku, pod, robot, station))

    def bundle_stored(self, bundle, robot):
        self.stored[bundle.sku, bundle.pod] += bundle.units
        self.log.append((bundle.stored_s, "store", bundle.index, bundle.pod, robot))

    def order_completed(self, order):
        self.completed.append(order)
        self.log.append((order.completed_s, "complete", order.index))

    def task_started(self, time_s, robot, kind, station):
        self.log.append((time_s, kind, robot, station))

    def check(self):
        """Stock and requests are conserved, per SKU and pod and per order line."""
        verify(self.world, self.completed)
        expected = self.initial + self.stored - self.picked
        assert np.array_equal(self.world.inventory.contained, expected)
        assert len(self.completed) == self.world.orders_completed
        for order in self.orders.values():
            for line in order.lines:
                assert self.picks[order.index, line.sku] == line.picked_units
        for order in self.completed:
            assert all(line.picked_units == line.units for line in order.lines)
            assert order.created_s <= order.assigned_s <= order.completed_s


def check_delays(run):
    """Every line, and every order, is accounted for without remainder."""
    lines = run.table("delays")
    parts = [f"{part}_s" for part in PARTS]
    assert (lines[parts] >= 0).all(axis=None), lines[(lines[parts] < 0).any(axis=1)].T
    assert np.allclose(lines[parts].sum(axis=1), lines["turnover_s"], rtol=0, atol=1e-9)
    orders = run.table("orders")
    completed = orders[orders["completed_s"].notna()].set_index("order")
    split = by_order(lines)
    assert list(split.index) == sorted(completed.index)
    turnover_s = completed.loc[split.index, "turnover_s"]
    assert np.allclose(split[parts].sum(axis=1), turnover_s, rtol=0, atol=1e-9)
    assert (lines.groupby("order").size() == completed["lines"].sort_index()).all()
