"""Converts events of a run into triggers, after which controllers may be called."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.problems import Trigger
from rmfs.observer import Observer

if TYPE_CHECKING:
    from rmfs.simulation.steps import Due
    from rmfs.world.orders import Bundle, Order


class Triggers(Observer):
    """Creates triggers from events; `Trigger` describes the subject of each.

    Parameters
    ----------
    due
        Notified of each trigger and its subject, and when a robot has left a storage location.
    """

    def __init__(self, due: Due) -> None:
        self._signal = due.signal
        self._place_left = due.place_left

    def order_created(self, order: Order) -> None:
        """Signal that a new order can be assigned."""
        self._signal(Trigger.NEW_ORDER, order)

    def order_cut(self, order: Order) -> None:
        """Signal that an order has lost the units that kept it from being assigned."""
        self._signal(Trigger.ORDER_CUT, order)

    def order_assigned(self, order: Order) -> None:
        """Signal that an order was assigned and may need pods."""
        self._signal(Trigger.ORDER_ASSIGNED, order)

    def order_queued(self, order: Order) -> None:
        """Signal that an order joined a station's pool; pods may be fetched for it in advance."""
        self._signal(Trigger.ORDER_QUEUED, order)

    def pool_changed(self, station: int) -> None:
        """Signal that there may be other pods to fetch for the orders in a station's pool."""
        self._signal(Trigger.POOL_CHANGED, station)

    def unit_picked(
        self,
        time_s: float,
        order: Order,
        sku: int,
        pod: int,
        robot: int,
        station: int,
        late_bound: bool,
    ) -> None:
        """Signal that the pick of a unit has made room on its pod."""
        self._signal(Trigger.UNIT_PICKED, (pod, sku))

    def slot_freed(self, order: Order) -> None:
        """Signal that a station can take another order."""
        self._signal(Trigger.ORDER_COMPLETED, order)

    def bundle_created(self, bundle: Bundle) -> None:
        """Signal that a bundle needs a pod and a station."""
        self._signal(Trigger.NEW_BUNDLE, bundle)

    def bundle_promised(self, bundle: Bundle) -> None:
        """Signal that the pod of a bundle was chosen."""
        self._signal(Trigger.BUNDLE_PROMISED, bundle)

    def bundles_released(self, pod: int) -> None:
        """Signal that ROA and TA may now act on the bundles promised to a pod."""
        self._signal(Trigger.BUNDLE_RELEASED, pod)

    def bundle_sent(self, bundle: Bundle) -> None:
        """Signal that the station of a bundle was chosen."""
        self._signal(Trigger.BUNDLE_SENT, bundle)

    def bundle_assigned(self, bundle: Bundle) -> None:
        """Signal that a bundle has a station and a pod, which may have to be brought there."""
        self._signal(Trigger.BUNDLE_ASSIGNED, bundle)

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Signal that there are more units in stock."""
        self._signal(Trigger.BUNDLE_STORED, bundle)

    def station_activated(self, time_s: float, station: int, active: bool) -> None:
        """Signal that a station was switched on or off."""
        self._signal(Trigger.STATION_SWITCHED, station)

    def robot_free(self, robot: int) -> None:
        """Signal that a robot needs a task."""
        self._signal(Trigger.ROBOT_FREE, robot)

    def place_left(self, robot: int) -> None:
        """Signal that a robot has left a storage location, for which others may be waiting."""
        self._place_left()

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Signal that a robot starts to lift a pod."""
        self._signal(Trigger.POD_LIFTED, pod)

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Signal that a robot, with or without a pod, reached the head of a station's queue."""
        self._signal(Trigger.POD_AT_STATION, station)
