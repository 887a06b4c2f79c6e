"""Operations on orders, which arrive, join pools, take slots, may lose units, and are completed.

The pool of a pick station consists of orders of the backlog that are reserved for it.
"""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

from rmfs.world.orders import Order
from rmfs.world.state import WorldState

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rmfs.world.orders import OrderLine
    from rmfs.world.stations import PickStation
    from rmfs.world.tasks import Pick, PickTask


class OrderOperations(WorldState):
    """The operations on orders."""

    def add_order(self, order: Order) -> None:
        """Add an order to the backlog."""
        for line in order.lines:
            self.inventory.demand(line.sku, line.units)
        self.orders.add(order)
        self.orders_created += 1

    def cut_order(self, order: Order, keep: Mapping[int, int]) -> None:
        """Reduce the units of an order in the backlog; cancel the order if no units are left.

        Parameters
        ----------
        keep
            Units that remain, by SKU; a SKU without an entry loses all its units.

        Raises
        ------
        ValueError
            If the order is not in the backlog, is in the pool of a station, or has been split.
        """
        if order not in self.orders or order.queued_at >= 0 or order.parts:
            raise ValueError(f"order {order.index} cannot lose units")
        for line in order.lines:
            self.inventory.undemand(line.sku, line.units - keep.get(line.sku, 0))
        if any(keep.values()):
            order.cut(keep)
            self.orders.lines_changed(order)
        else:
            self.orders.remove(order)
            order.cut(keep)
            order.cancelled_s = self.now_s

    def queue_order(self, order: Order, station: int) -> None:
        """Add an order to the pool of a pick station, that is, reserve the order for this station.

        The order needs no slot and stays in the backlog, but its requests can be bound to pods.

        Raises
        ------
        ValueError
            If the order is in a pool already, or not in the backlog.
        """
        if order.queued_at >= 0:
            raise ValueError(f"order {order.index} is queued at station {order.queued_at} already")
        if order not in self.orders:
            raise ValueError(f"order {order.index} is not in the backlog")
        target = self.pick_stations[station]
        target.queued[order.index] = order
        target.queued_requests.add(order)
        order.queued_at = station
        order.queued_s = self.now_s
        self.orders.queue_changed(order)

    def unqueue_all(self) -> None:
        """Empty the pools of all pick stations."""
        for station in self.pick_stations:
            for order in list(station.queued.values()):
                self.unqueue_order(order)

    def unqueue_order(self, order: Order) -> None:
        """Remove an order from its pool and reopen those of its requests that are bound to pods."""
        station = self.pick_stations[order.queued_at]
        for task in station.tasks.values():
            self._give_back(task, [pick for pick in task.picks if pick.line.order is order])
        self._leave_pool(order)
        self.orders.queue_changed(order)

    def assign_order(self, order: Order, station: int) -> Order:
        """Assign an order of the backlog, with its open requests, to a pick station.

        If the order was in the station's pool, requests already bound to pods stay bound. If a part
        of the order is at the station already, the remaining lines join that part.

        Returns
        -------
        Order
            The order, or the part of it, that occupies the slot.

        Raises
        ------
        ValueError
            If the order is in the pool of another station; or if the order needs a slot, and the
            station is inactive or has no free slot.
        """
        target = self.pick_stations[station]
        joins = order.index in target.orders
        if not joins and (not target.active or target.free_slots <= 0):
            raise ValueError(f"station {station} takes no order now")
        if order.queued_at >= 0:
            if order.queued_at != station:
                raise ValueError(f"order {order.index} is queued at station {order.queued_at}")
            self._leave_pool(order)
        if joins:
            return self.assign_lines(order, station, [line.sku for line in order.lines])
        self.orders.remove(order)
        order.station = station
        if isnan(order.assigned_s):
            order.assigned_s = self.now_s
        order.slot_s = self.now_s
        order.slots_taken += 1
        target.orders[order.index] = order
        target.changed()
        self._open(target, order.lines)
        return order

    def assign_lines(self, order: Order, station: int, skus: Collection[int]) -> Order:
        """Split an order of the backlog: assign its lines of the given SKUs to a pick station.

        If a part of the order is at the station already, the lines join that part. Otherwise, if
        the order has no further lines in the backlog, the order itself takes a slot; if it has, the
        lines become a new part, which takes a slot.

        Returns
        -------
        Order
            The part, or the order itself, that is now at the station.

        Raises
        ------
        ValueError
            If the order has no line of these SKUs, is not in the backlog, or is in a pool; or if a
            slot is needed, and the station is inactive or has no free slot.
        """
        target = self.pick_stations[station]
        lines = tuple(line for line in order.lines if line.sku in skus)
        if not lines or order not in self.orders or order.queued_at >= 0:
            raise ValueError(f"order {order.index} cannot give these lines")
        part = target.orders.get(order.index)
        if part is None:
            if len(lines) == len(order.lines):
                return self.assign_order(order, station)
            if not target.active or target.free_slots <= 0:
                raise ValueError(f"station {station} takes no order now")
            now_s = self.now_s
            part = Order(
                order.index, order.created_s, order.due_s, (), 0, 0, station, now_s, whole=order
            )
            part.priority, part.weight, part.slot_s = order.priority, order.weight, now_s
            order.parts.append(part)
            order.slots_taken += 1
            self.split_orders[order.index] = order
            target.orders[order.index] = part
            target.changed()
        if isnan(order.assigned_s):
            order.assigned_s = self.now_s
        part.take_over(lines)
        if order.lines:
            self.orders.lines_changed(order)
        else:
            self.orders.remove(order)
            order.station = station
        self._open(target, lines)
        return part

    def _open(self, station: PickStation, lines: tuple[OrderLine, ...]) -> None:
        """Count lines as lines of a station, and add their open requests to the station's."""
        station.requests.add_lines(lines)
        for line in lines:
            self._lines[station.index, line.sku] += 1
            self.inventory.commit(line.sku, line.open_units)

    def _leave_pool(self, order: Order) -> None:
        station = self.pick_stations[order.queued_at]
        del station.queued[order.index]
        station.queued_requests.remove(order)
        order.queued_at = -1

    def complete_order(self, order: Order) -> Order | None:
        """Remove a completely picked order, or part of one, from its station.

        Returns
        -------
        Order or None
            The customer's order, if it is now complete; None if other parts of it are at stations
            or some of its lines are in the backlog.

        Raises
        ------
        ValueError
            If a unit of `order` has not been picked.
        """
        if order.unpicked_units:
            raise ValueError(f"order {order.index} lacks {order.unpicked_units} units")
        station = self.pick_stations[order.station]
        del station.orders[order.index]
        station.changed()
        for line in order.lines:
            self._lines[order.station, line.sku] -= 1
        whole = order
        if order.whole is not None:
            whole, order.completed_s = order.whole, self.now_s
        whole.slots_taken -= 1
        if whole.slots_taken or whole in self.orders:
            return None
        whole.completed_s = self.now_s
        self.orders_completed += 1
        self.split_orders.pop(whole.index, None)
        return whole

    def _give_back(self, task: PickTask, picks: list[Pick]) -> None:
        pool = self.pick_stations[task.station].queued_requests
        for pick in reversed(picks):
            line = pick.line
            task.picks.remove(pick)
            pool.reopen(line)
            self.inventory.unbind(task.pod, line.sku, 1)
            self.inventory.commit(line.sku, -1)
            self.orders.changed(line)
