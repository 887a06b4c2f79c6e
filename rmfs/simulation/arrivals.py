"""Arrivals: orders and bundles come into being, as the scenario says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.scenario import Site, bundle_intake, order_intake
from rmfs.scenario.due import ClassesDue
from rmfs.scenario.streams import BundleStream, OrderStream
from rmfs.world.orders import Bundle, Order

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.scenario import BundleArrival, OrderArrival, Scenario, StreamRecorder
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.events import Events
    from rmfs.world import World
    from rmfs.world.stations import PickStation, ReplenishmentStation


class ArrivalProcess:
    """Asks the scenario what comes, at the times it names and after every change.

    It is what the scenario sees of the run (`rmfs.scenario.State`).

    Parameters
    ----------
    seed
        Of the run.
    wanted
        Called when it wants to be asked.
    recorder
        Keeps all orders and bundles that come.
    """

    def __init__(
        self,
        layout: Layout,
        scenario: Scenario,
        seed: int,
        *,
        agenda: Agenda,
        world: World,
        events: Events,
        wanted: Callable[[], None],
        recorder: StreamRecorder | None = None,
    ) -> None:
        self._agenda, self._world, self._events = agenda, world, events
        self._wanted = wanted
        site = Site(
            pick_stations=len(layout.pick_stations),
            replenishment_stations=len(layout.replenishment_stations),
            capacity=world.inventory.total_capacity,
            largest_pod=float(layout.pod_capacity.max(initial=0.0)),
        )
        due = scenario.orders.due
        self._classes = due.classes if isinstance(due, ClassesDue) else ()
        self._orders = order_intake(scenario, world.skus, site, seed, recorder)
        self._bundles = bundle_intake(scenario, world.skus, site, seed, recorder)
        self._woken_us = self._wake = -1

    @property
    def order_stream(self) -> OrderStream | None:
        """The orders of a file, if the scenario names one."""
        stream = self._orders.stream
        return stream if isinstance(stream, OrderStream) else None

    @property
    def bundle_stream(self) -> BundleStream | None:
        """The bundles of a file, if the scenario names one."""
        stream = self._bundles.stream
        return stream if isinstance(stream, BundleStream) else None

    def top_up(self) -> None:
        """Make the orders and bundles that come now."""
        now_us = self._agenda.now_us
        for order in self._orders.due(now_us, self):
            self._add_order(order)
        for bundle in self._bundles.due(now_us, self):
            self._add_bundle(bundle)
        self._wake_at(min(self._orders.next_us, self._bundles.next_us))

    def redraw(self) -> None:
        """Draw again when orders and bundles come next; see `Intake.redraw`."""
        now_us = self._agenda.now_us
        if self._woken_us > now_us:
            self._agenda.cancel(self._wake)
            self._woken_us = -1
        self._orders.redraw(now_us)
        self._bundles.redraw(now_us)
        self._wake_at(min(self._orders.next_us, self._bundles.next_us))

    def _add_order(self, arrival: OrderArrival) -> None:
        world = self._world
        world.order_redraws += arrival.redraws
        left = world.inventory.uncommitted.item
        world.orders_short += any(
            left(sku) < units for sku, units in zip(arrival.skus, arrival.units, strict=True)
        )
        order = Order.of(
            world.orders_created, world.now_s, arrival.due_s, arrival.skus, arrival.units
        )
        order.in_file = arrival.in_file
        if arrival.priority >= 0:
            order.priority = arrival.priority
            order.weight = self._classes[arrival.priority].weight
        world.add_order(order)
        self._events.order_created(order)

    def _add_bundle(self, arrival: BundleArrival) -> None:
        world = self._world
        bundle = Bundle(
            world.bundles_created, arrival.sku, arrival.units, arrival.space, world.now_s
        )
        bundle.in_file = arrival.in_file
        world.add_bundle(bundle)
        self._events.bundle_created(bundle)

    def _wake_at(self, time_us: int) -> None:
        """Ask again at a time, unless that has been arranged already."""
        if time_us != self._woken_us:
            self._woken_us = time_us
            self._wake = self._agenda.at(time_us, self._wanted)

    # --- what the scenario sees of the run ------------------------------------------------------

    @property
    def waiting_orders(self) -> int:
        """Orders not yet at a station."""
        return len(self._world.orders.orders)

    @property
    def waiting_bundles(self) -> int:
        """Bundles not yet assigned to a station and a pod."""
        return len(self._world.bundles.bundles)

    @property
    def stored_space(self) -> float:
        """Space units stored on all pods."""
        return self._world.inventory.stored_space

    @property
    def load(self) -> float:
        """Space units of what is stored, on its way into pods, and waiting."""
        return self._world.load

    @property
    def uncommitted(self) -> NDArray[np.int64]:
        """Units of each SKU stored less those that orders want."""
        return self._world.inventory.uncommitted

    @property
    def incoming(self) -> NDArray[np.int64]:
        """Units of each SKU in bundles that have come and are not stored yet."""
        return self._world.incoming

    @property
    def active_pick_share(self) -> float:
        """Active pick stations / all of them; one is counted at least."""
        return _active_share(self._world.pick_stations)

    @property
    def active_replenishment_share(self) -> float:
        """Active replenishment stations / all of them; one is counted at least."""
        return _active_share(self._world.replenishment_stations)


def _active_share(stations: Sequence[PickStation] | Sequence[ReplenishmentStation]) -> float:
    return max(1, sum(station.active for station in stations)) / max(1, len(stations))
