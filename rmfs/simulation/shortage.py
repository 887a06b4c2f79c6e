"""Orders that the stock cannot serve: detected after a waiting time, then cut or cancelled."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rmfs.observer import Observer
from rmfs.simulation.agenda import us_at

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.scenario.parameters.shortage import Shortage
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.events import Events
    from rmfs.world import World
    from rmfs.world.orders import Order


class ShortOrders(Observer):
    """Checks each order in the backlog after a given waiting time, and periodically after that.

    Only units that are in stock and not needed by orders at stations count as available. If they do
    not suffice for an order, it is cut to the available units or cancelled, depending on the
    policy. An order that is in a station's pool or has been split is already being served and is
    not changed.

    Parameters
    ----------
    given
        The scenario's table `orders.shortage`; its policy is `partial` or `cancel`.
    changed
        Called when an order has been cancelled.
    """

    def __init__(
        self,
        given: Shortage,
        *,
        agenda: Agenda,
        world: World,
        events: Events,
        changed: Callable[[], None],
    ) -> None:
        self._given = given
        self._agenda, self._world, self._events = agenda, world, events
        self._changed = changed

    def order_created(self, order: Order) -> None:
        """Schedule the check of a new order."""
        self._later(order)

    def _later(self, order: Order) -> None:
        at_us = self._agenda.now_us + us_at(self._given.after_s)
        self._agenda.at(at_us, partial(self._look, order))

    def _look(self, order: Order) -> None:
        world = self._world
        if order not in world.orders or order.parts:
            return
        free = world.inventory.free_stock.item
        short = order.queued_at < 0 and any(free(line.sku) < line.units for line in order.lines)
        if not short:
            self._later(order)
            return
        keep: dict[int, int] = {}
        if self._given.policy == "partial":
            keep = {line.sku: max(0, min(line.units, free(line.sku))) for line in order.lines}
        world.cut_order(order, keep)
        if order.lines:
            self._events.order_cut(order)
            self._later(order)
        else:
            self._events.order_cancelled(order)
            self._changed()


def short_orders(
    given: Shortage,
    *,
    agenda: Agenda,
    world: World,
    events: Events,
    changed: Callable[[], None],
) -> list[Observer]:
    """Return a list with the observer that checks orders; empty if the policy is `wait`."""
    if given.policy == "wait":
        return []
    return [ShortOrders(given, agenda=agenda, world=world, events=events, changed=changed)]
