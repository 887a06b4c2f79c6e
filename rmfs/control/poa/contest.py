"""Orders that compete for one station, and are rated by the criteria of the POA rule `queue`."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.stations import PickStation


class Contest:
    """N backlog orders that compete for a place in the pool of a station, or for a slot there.

    Attributes
    ----------
    rows
        Rows of the orders in the arrays of the backlog (`view.orders`), shape (N,).
    for_pool
        Whether the orders compete for a place in the pool; otherwise they compete for a slot.
    sku, units
        SKU of each order line, and the number of the line's units that are not yet bound to a pod,
        shape (N, L). An order has at most L lines; in unused columns, there are 0 units.
    """

    def __init__(
        self,
        view: View,
        station: PickStation,
        rows: NDArray[np.intp],
        for_pool: bool,
        sku: NDArray[np.int64],
        units: NDArray[np.int32],
    ) -> None:
        self.view = view
        self.station = station
        self.rows = rows
        self.for_pool = for_pool
        self.sku = sku
        self.units = units

    @classmethod
    def of(
        cls, view: View, station: PickStation, rows: NDArray[np.intp], *, for_pool: bool
    ) -> Contest:
        """Return the contest of the orders in the given rows of the backlog."""
        orders = view.orders
        return cls(view, station, rows, for_pool, orders.sku[rows], orders.units[rows])

    def at(self, station: PickStation) -> Contest:
        """Return a contest of the same orders, for another station."""
        return Contest(self.view, station, self.rows, self.for_pool, self.sku, self.units)

    def narrowed(self, to: NDArray[np.bool_]) -> Contest:
        """Return a contest of those orders for which `to`, of shape (N,), is true."""
        sku, units = self.sku[to], self.units[to]
        return Contest(self.view, self.station, self.rows[to], self.for_pool, sku, units)

    def __len__(self) -> int:
        return len(self.rows)

    def orders(self) -> list[Order]:
        """Return the N orders as objects."""
        at_row = self.view.orders.at_row
        return [at_row[row] for row in self.rows.tolist()]

    def claimed(self) -> NDArray[np.int32]:
        """Return how many units of each of the K SKUs are claimed by other orders, shape (K,).

        The other orders, which have precedence, are those with a slot at the station and, if the
        contest is for the pool, those already in the pool. Only units that are not yet bound to a
        pod count.
        """
        claimed: NDArray[np.int32] = self.view.need[self.station.index]
        if self.for_pool:
            claimed = claimed + self.view.queued_need[self.station.index]
        return claimed

    def company(self) -> NDArray[np.bool_]:
        """Return which of the K SKUs occur in the present orders of the station, shape (K,).

        These are the orders in the pool if the contest is for the pool, else the orders with a slot
        at the station. Lines that have already been picked count, too.
        """
        wanted = np.zeros(len(self.view.skus), np.bool_)
        if self.for_pool:
            wanted[[line.sku for o in self.station.queued.values() for line in o.lines]] = True
        else:
            wanted |= self.view.lines[self.station.index] > 0
        return wanted

    def inbound(self) -> tuple[list[int], NDArray[np.float64]]:
        """Return the pods at the station or on their way there, nearest first, and their distances.

        The distance in m is the length of a loaded robot's shortest path from the pod's current
        position to the station.
        """
        pods = list(self.station.tasks)
        far = self.view.travel.distances_to(self.station.waypoint, "path")
        metres = far[[self.view.pod_waypoint(pod) for pod in pods]] if pods else np.empty(0)
        nearest_first = metres.argsort(kind="stable")
        return [pods[place] for place in nearest_first.tolist()], metres[nearest_first]

    def completed_by(self, pod: int) -> NDArray[np.bool_]:
        """Return whether each order can be completed by a given pod, shape (N,).

        The pod is at the station or on its way there. It can complete an order if it has all units
        that the order still needs, in addition to those that orders with a slot need, and if no
        unit of the order is bound to another pod.
        """
        spare = self.view.inventory.available[:, pod][self.sku]
        spare = spare - self.view.need[self.station.index][self.sku]
        completes = np.asarray(((spare >= self.units) | (self.units == 0)).all(axis=1))
        if completes.any() and self.station.queued:
            picks = Counter(id(pick.line.order) for pick in self.station.tasks[pod].picks)
            for place in completes.nonzero()[0].tolist():
                order = self.view.orders.at_row[self.rows[place]]
                completes[place] = order.unpicked_units - order.open_units <= picks[id(order)]
        return completes

    def completed_by_all(self) -> NDArray[np.bool_]:
        """Return whether each order can be completed by all `inbound` pods together, shape (N,).

        The pods can complete an order if they have all units that the order still needs, in
        addition to those that `claimed` counts.
        """
        spare = self.view.inventory.inbound[self.station.index][self.sku]
        spare = spare - self.claimed()[self.sku]
        return np.asarray(((spare >= self.units) | (self.units == 0)).all(axis=1))
