"""Input of the planning model: waiting and open orders, pods under way, and contents of pods."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs, integers, number, reals, require

Integers = NDArray[np.int64]
Reals = NDArray[np.float64]

MOST_VISITS = 64
"""Maximum number of visits per station: a set of visits is stored as the bits of one number."""


@dataclass(frozen=True)
class Planning:
    """Orders, pods and stations at one instant, for a plan of several visits to each station.

    A *visit* is one pod at one station. Pods under way make the first visits to their station, in
    the order in which they arrive. New visits follow; each pod makes at most one new visit. Visits
    of a station are numbered from 0, those of pods under way included.

    A line is served by a single visit. A waiting order occupies a slot from the first visit that
    serves it to the last, at which it *closes*; an open order already occupies one. Orders that are
    served by a single visit take turns at one slot during this visit; the station keeps this slot
    free between visits. A station whose open orders occupy all slots keeps none free (see `kept`).

    Parameters
    ----------
    slots
        Number of order slots of each station, at least 1, shape (S,).
    coming
        Pods under way, shape (F,); pods to the same station are in order of arrival.
    coming_to
        Station to which each pod of `coming` is under way, shape (F,).
    order_station
        Station at which an order is open, or -1 if it waits, shape (O,).
    order_until
        Number of the last visit in which a pod under way brings units reserved for the order,
        shape (O,); -1 if there is no such visit, and for waiting orders.
    order_worth
        Reward for closing an order, in addition to the rewards for its lines, shape (O,), in s of
        robot time.
    line_order, line_sku, line_units
        Order, SKU and units of each line to be planned, shape (L,). A waiting order has at least
        one line.
    line_worth
        Reward for serving a line, shape (L,), in s of robot time.
    stock
        Unreserved units per pod and SKU, shape (P, K).
    cost
        Cost of a new visit, shape (P, S), in s: the robot time without the service at the station,
        minus the value of keeping the station busy. It is inf if the visit is not allowed, and must
        be inf for pods under way.
    visits
        Maximum number of new visits per station.
    decay
        Discount factor in (0, 1]: rewards and costs of visit v of a station are multiplied by
        decay ** v.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    slots: Integers
    coming: Integers
    coming_to: Integers
    order_station: Integers
    order_until: Integers
    order_worth: Reals
    line_order: Integers
    line_sku: Integers
    line_units: Integers
    line_worth: Reals
    stock: Integers
    cost: Reals
    visits: int
    decay: float = 1.0

    def __post_init__(self) -> None:
        slots = integers("slots", self.slots, (None,), low=1)
        stock = integers("stock", self.stock, (None, None), low=0)
        stations, (pods, skus) = len(slots), stock.shape
        coming = integers("coming", self.coming, (None,), low=0, high=pods - 1)
        order_station = integers(
            "order_station", self.order_station, (None,), low=-1, high=stations - 1
        )
        orders = len(order_station)
        line_order = integers("line_order", self.line_order, (None,), low=0, high=orders - 1)
        lines = len(line_order)
        checked = {
            "slots": slots,
            "stock": stock,
            "coming": coming,
            "coming_to": integers(
                "coming_to", self.coming_to, (len(coming),), low=0, high=stations - 1
            ),
            "order_station": order_station,
            "order_until": integers("order_until", self.order_until, (orders,), low=-1),
            "order_worth": reals("order_worth", self.order_worth, (orders,), low=0.0),
            "line_order": line_order,
            "line_sku": integers("line_sku", self.line_sku, (lines,), low=0, high=skus - 1),
            "line_units": integers("line_units", self.line_units, (lines,), low=1),
            "line_worth": reals("line_worth", self.line_worth, (lines,), low=0.0),
            "cost": costs("cost", self.cost, (pods, stations)),
        }
        for field, value in checked.items():
            object.__setattr__(self, field, value)
        number("visits", self.visits, low=0)
        number("decay", self.decay, low=0.0, high=1.0)
        require(self.decay > 0, "decay", "must be above 0")
        require(len(set(coming.tolist())) == len(coming), "coming", "must name each pod once")
        require(bool(np.isinf(self.cost[coming]).all()), "cost", "must be inf for pods under way")
        waits = self.order_station < 0
        have = np.bincount(line_order, minlength=orders) > 0
        require(bool(have[waits].all()), "line_order", "must name a line of each waiting order")
        under_way = np.array([len(found) for found in self.under_way], np.int64)
        longest = int(under_way.max(initial=0)) + self.visits
        require(
            longest <= MOST_VISITS,
            "visits",
            f"a station may have at most {MOST_VISITS} visits, those under way included",
        )
        until = self.order_until[~waits]
        require(
            bool((until < under_way[self.order_station[~waits]]).all()),
            "order_until",
            "must be a visit under way to the order's station, or -1",
        )
        require(
            bool((self.order_until[waits] < 0).all()),
            "order_until",
            "must be -1 for a waiting order",
        )

    @property
    def stations(self) -> int:
        """Number of stations."""
        return len(self.slots)

    @property
    def orders(self) -> int:
        """Number of orders."""
        return len(self.order_station)

    @property
    def lines(self) -> int:
        """Number of order lines."""
        return len(self.line_order)

    @property
    def pods(self) -> int:
        """Number of pods."""
        return len(self.stock)

    @cached_property
    def under_way(self) -> list[list[int]]:
        """Pods under way to each station, in order of arrival."""
        found: list[list[int]] = [[] for _ in range(self.stations)]
        for pod, station in zip(self.coming.tolist(), self.coming_to.tolist(), strict=True):
            found[station].append(pod)
        return found

    @cached_property
    def kept(self) -> list[int]:
        """Number of orders that each station may keep open from one visit to the next.

        This is the larger of two numbers: the number of the station's slots minus one, and the
        number of its open orders that may remain open after the first visit (orders that have lines
        to plan, or for which the second or a later pod under way brings units).
        """
        stays = self.order_until > 0
        stays[self.line_order] = True
        open_now = np.bincount(
            self.order_station[stays & (self.order_station >= 0)], minlength=self.stations
        )
        most: list[int] = np.maximum(self.slots - 1, open_now).tolist()
        return most
