"""Independent bookkeeping of energy: what the trace says was drawn, what batteries say is left."""

from __future__ import annotations

from bisect import bisect_right

import numpy as np

from rmfs.observer import Observer
from rmfs.traffic import Piece

GRAVITY = 9.80665


class EnergyLedger(Observer):
    """Follows the masses of pods by itself, and works out of the trace what each robot drew."""

    def run_started(self, run):
        self.layout, self.given, self.traffic = run.layout, run.scenario.energy, run.traffic
        # robots that are slow for a while drive otherwise than their kind says
        self.slow = run.scenario.disturbances.slow is not None
        if self.given is None:
            return
        self.space = run.world.inventory.unit_space.tolist()
        used = run.world.inventory.unit_space @ run.world.inventory.contained
        kg = self.given.goods_kg_per_space
        self.kg = (self.given.pod_kg + kg * used).tolist()
        self.changes = [([0], [mass]) for mass in self.kg]

    def weigh(self, pod, space, time_s):
        if self.given is None:
            return
        self.kg[pod] += self.given.goods_kg_per_space * space
        since, mass = self.changes[pod]
        since.append(round(time_s * 1e6))
        mass.append(self.kg[pod])

    def unit_picked(self, time_s, order, sku, pod, robot, station, late_bound):
        if self.given is not None:
            self.weigh(pod, -self.space[sku], time_s)

    def bundle_stored(self, bundle, robot):
        self.weigh(bundle.pod, bundle.space, bundle.stored_s)

    def run_ended(self, time_s):
        """Fail unless the balance holds; what was drawn comes from the trace, if there is one."""
        if self.given is None:
            return
        try:
            trace = self.traffic.trace()
        except ValueError:
            trace = None
        self.balance(self.traffic.energy(), trace, time_s)

    def mass(self, pod, time_us):
        """What a pod weighed when a piece of motion began."""
        since, mass = self.changes[pod]
        return mass[bisect_right(since, time_us) - 1]

    def drawn_j(self, trace, until_us):
        """J per robot until then, and which robots are in the middle of a move."""
        drawn, whole = np.zeros(self.layout.robots), np.ones(self.layout.robots, bool)
        rows = zip(*(trace[name].tolist() for name in COLUMNS), strict=True)
        for robot, start, end, kind, begin_at, end_at, before, after, pod in rows:
            if end > until_us:
                whole[robot] = False
                continue
            e = self.given
            load = self.mass(pod, start) if pod >= 0 else 0.0
            mass = e.robot_kg + load
            watts = e.standby_loaded_w if pod >= 0 else e.standby_w
            drawn[robot] += watts * (end - start) / 1e6
            if kind == Piece.RUN:
                drawn[robot] += self.run(begin_at, end_at, mass)
            elif kind == Piece.TURN:
                drawn[robot] += self.turn(before, after, mass)
            elif kind == Piece.LIFT:
                drawn[robot] += load * GRAVITY * e.lift_m / e.lift_efficiency
        return drawn, whole

    def run(self, begin_at, end_at, mass):
        e, kind, layout = self.given, self.layout.robot_kinds[0], self.layout
        x = layout.x_m[end_at] - layout.x_m[begin_at]
        y = layout.y_m[end_at] - layout.y_m[begin_at]
        length, top = np.hypot(x, y), kind.top_speed_m_s
        a, b = kind.acceleration_m_s2, kind.deceleration_m_s2
        peak = min(top, np.sqrt(2 * a * b * length / (a + b)))
        resistance = e.rolling_resistance * mass * GRAVITY
        kinetic = (1 + e.inertia_share) * mass * peak**2 / 2
        braking = peak**2 / 2 / b
        surplus = kinetic - resistance * braking
        assert surplus > 0
        drawn = (resistance * (length - braking) + kinetic) / e.drive_efficiency
        return drawn - e.recuperation_share * surplus

    def turn(self, before, after, mass):
        e, kind = self.given, self.layout.robot_kinds[0]
        angle = abs((after - before + np.pi) % (2 * np.pi) - np.pi)
        kinetic = mass * (e.gyration_m * 2 * np.pi / kind.full_turn_s) ** 2 / 2
        steady = e.turning_resistance_m * mass * GRAVITY * angle
        return (steady + kinetic) / e.drive_efficiency - e.recuperation_share * kinetic

    def check(self, run):
        """The same with the trace of a run that is over."""
        self.balance(run.traffic.energy(), run.trace, run.end_s)

    def balance(self, told, trace, end_s):
        """Drawn = initial + charged - left, per robot, to 1e-9."""
        left = told["initial_j"] + told["ever_charged_j"] - told["level_j"]
        np.testing.assert_allclose(left, told["ever_used_j"], rtol=1e-9)
        if self.given.battery is not None:
            most = self.given.battery.capacity_wh * 3600 * (1 + 1e-9)
            assert (told["level_j"] <= most).all()
        if trace is not None and not self.slow:
            drawn, whole = self.drawn_j(trace, round(end_s * 1e6))
            np.testing.assert_allclose(left[whole], drawn[whole], rtol=1e-9)


COLUMNS = (
    *("robot", "t0_us", "t1_us", "kind", "from_wp", "to_wp"),
    *("heading0_rad", "heading1_rad", "pod"),
)
