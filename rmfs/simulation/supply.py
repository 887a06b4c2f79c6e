"""Supply: lets orders and bundles come into being, as the scenario says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.problems import Trigger
from rmfs.scenario import BundleSource, BundleTopUp, OrderSource, OrderTopUp
from rmfs.world.orders import Bundle, Order

if TYPE_CHECKING:
    from rmfs.scenario import Scenario
    from rmfs.simulation.simulation import Simulation


class Supply:
    """Keeps both backlogs at a constant length, with the pauses the scenario asks for.

    Topped up whenever the backlogs or the stock have changed, and when a failed attempt may be
    repeated.
    """

    def __init__(self, simulation: Simulation, scenario: Scenario, seed: int) -> None:
        self._simulation = simulation
        self._world = simulation.world
        capacity = simulation.world.inventory.total_capacity
        skus = simulation.world.skus
        self._order_source = OrderSource(scenario.orders, skus, seed, source=scenario.name)
        self._bundle_source = BundleSource(skus, seed)
        self._order_top_up = OrderTopUp(scenario.demand, capacity)
        self._bundle_top_up = BundleTopUp(scenario.replenishment, capacity)
        self._orders_drawn = 0
        self._bundles_drawn = 0

    def top_up(self) -> None:
        """Make orders and bundles until no more are wanted."""
        self._top_up_orders()
        self._top_up_bundles()

    def _top_up_orders(self) -> None:
        world, wants = self._world, self._order_top_up.wants
        now_s, inventory = world.now_s, world.inventory
        while wants(now_s, len(world.orders), inventory.stored_space):
            draft = self._order_source.draw(self._orders_drawn, inventory.uncommitted)
            self._orders_drawn += 1
            if draft is None:
                self._order_top_up.failed(now_s)
                self._try_again(self._order_top_up.blocked_until_s)
                return
            world.order_redraws += draft.redraws
            order = Order.of(
                world.orders_created, now_s, now_s + draft.due_offset_s, draft.skus, draft.units
            )
            world.add_order(order)
            self._simulation.observers.order_created(order)
            self._simulation.phase.signal(Trigger.NEW_ORDER, order)

    def _top_up_bundles(self) -> None:
        world, top_up = self._world, self._bundle_top_up
        now_s = world.now_s
        while top_up.wants(now_s, len(world.bundles), world.load):
            draft = self._bundle_source.draw(self._bundles_drawn)
            self._bundles_drawn += 1
            if not top_up.accepts(world.load, draft.space):
                top_up.failed(now_s)
                self._try_again(top_up.blocked_until_s)
                return
            bundle = Bundle(world.bundles_created, draft.sku, draft.units, draft.space, now_s)
            world.add_bundle(bundle)
            self._simulation.observers.bundle_created(bundle)
            self._simulation.phase.signal(Trigger.NEW_BUNDLE, bundle)

    def _try_again(self, time_s: float) -> None:
        simulation = self._simulation
        simulation.agenda.at(simulation.us_at(time_s), simulation.phase.supply_wanted)
