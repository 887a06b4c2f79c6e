"""A simulation whose orders, stock and bundles are entered by hand; robots are unhindered."""

from __future__ import annotations

from typing import Any

from doubles import FreeTraffic, quiet_scenario, rules, small_layout
from ledger import Ledger

from rmfs.observer import Observer
from rmfs.simulation.kernel import Kernel
from rmfs.simulation.pacing import PacingSettings
from rmfs.world import Bundle, Order


class Diary(Observer):
    """What happened, as (time, what, ...)."""

    def __init__(self) -> None:
        self.entries: list[tuple] = []

    def of(self, *kinds: str) -> list[tuple]:
        return [entry for entry in self.entries if entry[1] in kinds]

    def unit_picked(self, time_s, order, sku, pod, robot, station, late_bound):
        self.entries.append((time_s, "unit", order.index, sku, late_bound))

    def order_completed(self, order):
        self.entries.append((order.completed_s, "complete", order.index))

    def bundle_stored(self, bundle, robot):
        self.entries.append((bundle.stored_s, "store", bundle.index))

    def visit_started(self, time_s, station, pod, robot):
        self.entries.append((time_s, "arrive", station, pod))

    def visit_ended(self, time_s, station, pod, robot):
        self.entries.append((time_s, "leave", station, pod))

    def task_started(self, time_s, robot, kind, station):
        self.entries.append((time_s, kind, robot, station))

    def station_busy(self, station, from_s, to_s):
        self.entries.append((from_s, "busy", station, to_s))

    def pod_set_down(self, time_s, pod, robot, waypoint):
        self.entries.append((time_s, "set down", pod, waypoint))


class HandMade:
    """One simulation, its diary and its ledger."""

    def __init__(
        self,
        layout: dict[str, Any] | None = None,
        scenario: dict[str, Any] | None = None,
        observers: tuple[Observer, ...] = (),
        move_up_s: float = 0.0,
        pacing: PacingSettings | None = None,
        **problems: Any,
    ) -> None:
        plan = small_layout(**(layout or {}))
        self.diary, self.ledger = Diary(), Ledger()
        self.traffic = FreeTraffic(plan, move_up_s)
        self.simulation = Kernel(
            plan,
            quiet_scenario(**(scenario or {})),
            rules(**problems),
            observers=[self.diary, self.ledger, *observers],
            traffic=self.traffic,
            pacing=pacing,
        )
        self.world = self.simulation.world

    def stock(self, pod: int, **units: int) -> None:
        for sku, count in units.items():
            self.world.stock([pod], [int(sku[1:])], [count])

    def order(self, at_s: float = 0.0, due_s: float = 1e6, **units: int) -> None:
        """Let an order arrive."""
        skus = tuple(int(sku[1:]) for sku in units)

        def arrive() -> None:
            index = self.world.orders_created
            order = Order.of(index, self.world.now_s, due_s, skus, tuple(units.values()))
            self.world.add_order(order)
            self.simulation.events.order_created(order)

        self.at(at_s, arrive)

    def bundle(self, at_s: float = 0.0, sku: int = 0, units: int = 4) -> None:
        """Let a bundle arrive."""

        def arrive() -> None:
            space = float(units * self.world.skus.space_per_unit[sku])
            bundle = Bundle(self.world.bundles_created, sku, units, space, self.world.now_s)
            self.world.add_bundle(bundle)
            self.simulation.events.bundle_created(bundle)

        self.at(at_s, arrive)

    def at(self, time_s: float, callback) -> None:
        self.simulation.agenda.at(round(time_s * 1e6), callback)

    def run(self) -> Diary:
        self.simulation.run()
        self.ledger.check()
        return self.diary
