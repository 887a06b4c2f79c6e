"""Counts of a run, put into the inequalities that every run must satisfy (docs: bounds)."""

from __future__ import annotations

import numpy as np

from rmfs.measure.bound import at_best
from rmfs.observer import Observer
from rmfs.solvers.models.run_bound import Throughput, solve, violations
from rmfs.solvers.run_bound import run_bound


class Counter(Observer):
    """Units, bundles and visits of the measured time, per station."""

    def run_started(self, simulation):
        self.simulation = simulation
        self.stations = len(simulation.layout.stations)
        self.warmup_ended(0.0)

    def warmup_ended(self, time_s):
        self.began_s = time_s
        self.units, self.bundles, self.visits = np.zeros((3, self.stations))
        self.counted = [False] * self.stations

    def visit_started(self, time_s, station, pod, robot):
        self.counted[station] = False

    def _count(self, station):
        self.visits[station] += not self.counted[station]
        self.counted[station] = True

    def unit_picked(self, time_s, order, sku, pod, robot, station, late_bound):
        self.units[station] += 1
        self._count(station)

    def bundle_stored(self, bundle, robot):
        self.bundles[bundle.station] += 1
        self._count(bundle.station)

    def run_ended(self, time_s):
        """Fail if the run did what the proof says no run can do."""
        simulation = self.simulation
        layout = at_best(simulation.layout, simulation.world.staff)
        if layout is None:
            return
        data = run_bound(
            layout,
            simulation.world.skus,
            simulation.traffic,
            time_s - self.began_s,
        )
        if data is None:
            return
        picking = len(simulation.layout.pick_stations)
        ours = picking + len(simulation.layout.replenishment_stations)
        counts = Throughput(
            units=self.units[:picking],
            visits=self.visits[:picking],
            lone_units=self.units[:picking],
            bundles=self.bundles[picking:ours],
            refill_visits=self.visits[picking:ours],
        )
        assert not violations(data, counts), counts
        assert self.units.sum() <= solve(data).bound * data.hours
