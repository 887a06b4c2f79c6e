"""Orders and bundles that wait for decisions.

The orders of the backlog are kept as objects in order of arrival and, for rules that compare all of
them, as a padded matrix: one row per order, one column per line. When an order leaves, the last row
moves to its place, so that the matrix need not be rebuilt.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.traffic import _core as compiled  # the package has one compiled library

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.world.orders import Bundle, Order, OrderLine


class OrderBacklog:
    """Orders not yet assigned to a pick station: B orders with at most L lines each.

    Attributes
    ----------
    orders
        Orders by index, in order of arrival.
    at_row
        The order in each row of the matrix.
    """

    def __init__(self) -> None:
        self.orders: dict[int, Order] = {}
        self.at_row: list[Order] = []
        self._row_of: dict[int, int] = {}
        self._sku = np.zeros((64, 4), np.int64)
        self._units = np.zeros((64, 4), np.int32)
        self._due_s = np.zeros(64)
        self._weight = np.ones(64)
        self._index = np.zeros(64, np.int64)
        self._queued_at = np.full(64, -1, np.int32)

    def __len__(self) -> int:
        return len(self.orders)

    def __iter__(self) -> Iterator[Order]:
        return iter(self.orders.values())

    def __contains__(self, order: Order) -> bool:
        return order.index in self.orders

    @property
    def sku(self) -> NDArray[np.int64]:
        """SKU of each line, 0 where there is no line (see `units`), shape (B, L)."""
        return self._sku[: len(self.at_row)]

    @property
    def units(self) -> NDArray[np.int32]:
        """Open units of each line, 0 where there is no line, shape (B, L).

        A unit is open until it is bound to a pod. In the backlog, only units of orders in a
        station's pool can be bound.
        """
        return self._units[: len(self.at_row)]

    @property
    def due_s(self) -> NDArray[np.float64]:
        """Due time of each order in s, shape (B,)."""
        return self._due_s[: len(self.at_row)]

    @property
    def weight(self) -> NDArray[np.float64]:
        """Weight of each order's lateness, as set for the order's class, shape (B,)."""
        return self._weight[: len(self.at_row)]

    @property
    def index(self) -> NDArray[np.int64]:
        """Ordinal of arrival of each order, shape (B,)."""
        return self._index[: len(self.at_row)]

    @property
    def queued_at(self) -> NDArray[np.int32]:
        """Pick station in whose pool each order is, -1 if in none, shape (B,)."""
        return self._queued_at[: len(self.at_row)]

    def add(self, order: Order) -> None:
        """Add an order."""
        row = len(self.at_row)
        self._make_room(row + 1, len(order.lines))
        for column, line in enumerate(order.lines):
            self._sku[row, column] = line.sku
            self._units[row, column] = line.open_units
        self._due_s[row] = order.due_s
        self._weight[row] = order.weight
        self._index[row] = order.index
        self._queued_at[row] = order.queued_at
        self.at_row.append(order)
        self._row_of[order.index] = row
        self.orders[order.index] = order

    def remove(self, order: Order) -> None:
        """Remove an order; the last row of the matrix moves to the row of this order."""
        del self.orders[order.index]
        row = self._row_of.pop(order.index)
        last = self.at_row.pop()
        end = len(self.at_row)
        if row != end:
            self.at_row[row] = last
            self._row_of[last.index] = row
            self._sku[row] = self._sku[end]
            self._units[row] = self._units[end]
            self._due_s[row] = self._due_s[end]
            self._weight[row] = self._weight[end]
            self._index[row] = self._index[end]
            self._queued_at[row] = self._queued_at[end]
        self._sku[end] = 0
        self._units[end] = 0

    def changed(self, line: OrderLine) -> None:
        """Update the open units of a line after they have changed."""
        order = line.order
        self._units[self._row_of[order.index], order.lines.index(line)] = line.open_units

    def lines_changed(self, order: Order) -> None:
        """Update the lines of an order that has lost lines or units."""
        row = self._row_of[order.index]
        self._sku[row] = 0
        self._units[row] = 0
        for column, line in enumerate(order.lines):
            self._sku[row, column] = line.sku
            self._units[row, column] = line.open_units

    def queue_changed(self, order: Order) -> None:
        """Update `queued_at` for an order that has joined or left the pool of a station."""
        self._queued_at[self._row_of[order.index]] = order.queued_at

    def after(self, index: int) -> list[Order]:
        """Return the orders whose index is greater than `index`, latest first."""
        newer = []
        for order in reversed(self.orders.values()):
            if order.index <= index:
                break
            newer.append(order)
        return newer

    def servable(self, stock: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Whether `stock` would suffice for each order if it were the only order, shape (B,).

        Parameters
        ----------
        stock
            Units per SKU, shape (K,).
        """
        return compiled.servable(self.sku, self.units, stock)

    def _make_room(self, rows: int, lines: int) -> None:
        old_rows, old_lines = self._sku.shape
        if rows <= old_rows and lines <= old_lines:
            return
        more = (max(rows, 2 * old_rows) - old_rows if rows > old_rows else 0, 0)
        wider = (0, max(lines - old_lines, 0))
        pad = ((0, more[0]), wider)
        self._sku = np.pad(self._sku, pad)
        self._units = np.pad(self._units, pad)
        self._index = np.pad(self._index, pad[0])
        self._due_s = np.pad(self._due_s, pad[0])
        self._weight = np.pad(self._weight, pad[0])
        self._queued_at = np.pad(self._queued_at, pad[0], constant_values=-1)


class BundleBacklog:
    """Bundles that are not assigned yet.

    RPS chooses the pod of each bundle: the bundle is then *promised* to the pod. Later, RPS
    *releases* all bundles promised to a pod together. ROA chooses the station. A bundle is
    *assigned* as soon as it has been released and has a station.

    Attributes
    ----------
    bundles
        All bundles by index, in order of arrival.
    without_pod, without_station
        Bundles for which RPS has not chosen a pod yet, and those for which ROA has not chosen a
        station yet, in order of arrival.
    unreleased
        By pod, the bundles promised to it but not released.
    unreleased_since_s
        By pod, the time in s at which the latest of its unreleased bundles was promised; pods are
        sorted by this time.
    released
        By pod, the released bundles that have no station yet; pods whose bundles were released
        earlier come first.
    space
        Total space of all bundles, in space units.
    """

    def __init__(self) -> None:
        self.bundles: dict[int, Bundle] = {}
        self.without_pod: dict[int, Bundle] = {}
        self.without_station: dict[int, Bundle] = {}
        self.unreleased: dict[int, list[Bundle]] = {}
        self.unreleased_since_s: dict[int, float] = {}
        self.released: dict[int, list[Bundle]] = {}
        self.space = 0.0

    def __len__(self) -> int:
        return len(self.bundles)

    def __iter__(self) -> Iterator[Bundle]:
        return iter(self.bundles.values())

    def add(self, bundle: Bundle) -> None:
        """Add a bundle for which nothing has been decided."""
        self.bundles[bundle.index] = bundle
        self.without_pod[bundle.index] = bundle
        self.without_station[bundle.index] = bundle
        self.space += bundle.space

    def promised(self, bundle: Bundle, time_s: float) -> None:
        """Record that RPS chose a bundle's pod (`bundle.pod`); the bundle is not released yet."""
        del self.without_pod[bundle.index]
        self.unreleased.setdefault(bundle.pod, []).append(bundle)
        self.unreleased_since_s.pop(bundle.pod, None)
        self.unreleased_since_s[bundle.pod] = time_s

    def release(self, pod: int) -> list[Bundle]:
        """Release the bundles promised to a pod, and return them."""
        del self.unreleased_since_s[pod]
        bundles = self.unreleased.pop(pod)
        waiting = [bundle for bundle in bundles if bundle.station < 0]
        if waiting:
            self.released.setdefault(pod, []).extend(waiting)
        return bundles

    def station_chosen(self, bundle: Bundle) -> None:
        """Record that ROA chose the station of a bundle."""
        del self.without_station[bundle.index]
        if bundle.released:
            waiting = self.released[bundle.pod]
            waiting.remove(bundle)
            if not waiting:
                del self.released[bundle.pod]

    def remove(self, bundle: Bundle) -> None:
        """Remove a bundle that has been released and has a station."""
        del self.bundles[bundle.index]
        self.space -= bundle.space
