"""The input of the bound on picked units: stations, robots, stock, refill, demand, time window.

Except for the length of the window, every number is an extreme: a *least* time or a *largest*
amount. The bound is proven for all runs within these limits. If a number is uncertain, the
caller should pass a shorter time or a larger amount, which keep the bound valid (for example 0 for
a changeover, infinity for the demand).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import integers, number, reals, require


@dataclass(frozen=True)
class PickStations:
    """The pick stations; all arrays have shape (S,).

    Parameters
    ----------
    unit_transfer_s
        Least time for which the pick of one unit occupies the station, in s.
    unit_pick_s
        Least time for which the pick of one unit occupies the robot, in s. At each station,
        `unit_transfer_s` or `unit_pick_s` must be positive.
    changeover_s
        Least time from the moment a robot may leave the head of the queue until the next robot can
        be served, in s; 0 is always valid.
    inbound_s, outbound_s
        Least robot time to bring a pod to the station and to take it away, in s; see `visit_legs`.
    order_slots
        Maximum number of open orders.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    unit_transfer_s: NDArray[np.float64]
    unit_pick_s: NDArray[np.float64]
    changeover_s: NDArray[np.float64]
    inbound_s: NDArray[np.float64]
    outbound_s: NDArray[np.float64]
    order_slots: NDArray[np.int64]

    def __post_init__(self) -> None:
        count = np.shape(self.unit_transfer_s)[:1] or (None,)
        for field in ("unit_transfer_s", "unit_pick_s", "changeover_s", "inbound_s", "outbound_s"):
            checked = reals(field, getattr(self, field), count, low=0)
            object.__setattr__(self, field, checked)
        slots = integers("order_slots", self.order_slots, count, low=0)
        object.__setattr__(self, "order_slots", slots)
        require(
            bool((self.cadence_s > 0).all()),
            "unit_transfer_s",
            ("must be above 0: no station is infinitely fast"),
        )

    @property
    def cadence_s(self) -> NDArray[np.float64]:
        """Least time between the starts of two picks in a visit, shape (S,), in s.

        This is the longer of `unit_transfer_s` and `unit_pick_s`.
        """
        return np.maximum(self.unit_transfer_s, self.unit_pick_s)

    @property
    def change_s(self) -> NDArray[np.float64]:
        """Least time from the last pick of a visit to the first of the next, shape (S,), in s.

        It is measured from the start of the one pick to the start of the other.
        """
        return np.maximum(self.unit_transfer_s, self.unit_pick_s + self.changeover_s)


@dataclass(frozen=True)
class Refill:
    """The replenishment stations; all arrays have shape (Q,). If Q is 0, no pod is refilled.

    Parameters
    ----------
    bundle_transfer_s
        Least time for which storing one bundle occupies the station and the robot, in s, positive.
    inbound_s, outbound_s
        As for `PickStations`.
    bundle_units
        Maximum number of units in a bundle.
    bundles_per_visit
        Maximum number of bundles put into a pod in one visit.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    bundle_transfer_s: NDArray[np.float64]
    inbound_s: NDArray[np.float64]
    outbound_s: NDArray[np.float64]
    bundle_units: int
    bundles_per_visit: int

    def __post_init__(self) -> None:
        count = np.shape(self.bundle_transfer_s)[:1] or (None,)
        for field in ("bundle_transfer_s", "inbound_s", "outbound_s"):
            checked = reals(field, getattr(self, field), count, low=0)
            object.__setattr__(self, field, checked)
        fast = bool((self.bundle_transfer_s > 0).all())
        require(fast, "bundle_transfer_s", "must be above 0: no station is infinitely fast")
        number("bundle_units", self.bundle_units, low=1)
        number("bundles_per_visit", self.bundles_per_visit, low=1)


@dataclass(frozen=True)
class Stock:
    """Contents of the pods.

    Parameters
    ----------
    pod_units
        Largest possible number of units in each pod at the start of the window, shape (P,): the
        actual number if it is known, otherwise the number that fits (the capacity of the pod
        divided by the least space that a unit of any SKU needs).
    largest_pod_units
        Maximum number of units that any pod can hold at any time.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    pod_units: NDArray[np.int64]
    largest_pod_units: int

    def __post_init__(self) -> None:
        units = integers("pod_units", self.pod_units, (None,), low=0)
        object.__setattr__(self, "pod_units", units)
        number("largest_pod_units", self.largest_pod_units, low=int(units.max(initial=0)))


@dataclass(frozen=True)
class Orders:
    """Demand for units.

    Parameters
    ----------
    units
        Number of units ordered but not yet picked when the window begins (work in progress
        included), plus the units of the orders that arrive in the window. Default: unlimited, as
        with a backlog of constant size.
    largest_order_units
        Maximum number of units in an order; infinity if unknown. Default: unknown.
    lone_units
        Maximum total number of units in *lone* orders: orders served completely in one visit. If
        the orders are known, count the units of every order whose SKUs are all held by a single
        pod at some time in the window. Default: unlimited.
    join_visits
        Whether an order that is assigned to a station during a visit can still be served in that
        visit. Default: yes, which is always valid.

    Raises
    ------
    ModelError
        If a value is negative.
    """

    units: float = math.inf
    largest_order_units: float = math.inf
    lone_units: float = math.inf
    join_visits: bool = True

    def __post_init__(self) -> None:
        for field in ("units", "largest_order_units", "lone_units"):
            value = getattr(self, field)
            require(value >= 0, field, f"must be at least 0, is {value}")


@dataclass(frozen=True)
class RunBound:
    """A warehouse and the time window considered.

    Parameters
    ----------
    duration_s
        Length of the window in which picks are counted, H, in s, positive.
    robots
        Number of robots, R.
    picking, refill, stock, orders
        The pick stations, the replenishment stations, the contents of the pods, and the demand.

    Raises
    ------
    ModelError
        If a value is wrong.
    """

    duration_s: float
    robots: int
    picking: PickStations
    refill: Refill
    stock: Stock
    orders: Orders = Orders()

    def __post_init__(self) -> None:
        require(number("duration_s", self.duration_s) > 0, "duration_s", "must be positive")
        integers("robots", self.robots, (), low=0)

    def keeping_stock(self) -> RunBound:
        """Return the same problem for runs that store at least as many units as they pick.

        The bound then ignores the initial contents of the pods, because no more units are picked
        than are stored.
        """
        stock = Stock(np.zeros_like(self.stock.pod_units), self.stock.largest_pod_units)
        return replace(self, stock=stock)

    @property
    def hours(self) -> float:
        """Length of the window in h."""
        return self.duration_s / 3600.0

    @property
    def visit_units(self) -> NDArray[np.float64]:
        """Maximum number of units in one visit at each pick station, shape (S,).

        A pod is not refilled while units are picked from it, so a visit cannot yield more than the
        pod can hold. If orders cannot join a running visit (`Orders.join_visits` is False), a visit
        cannot yield more units than the open orders have, either.
        """
        largest = np.full(len(self.picking.order_slots), float(self.stock.largest_pod_units))
        if self.orders.join_visits or math.isinf(self.orders.largest_order_units):
            return largest
        asked = self.picking.order_slots * self.orders.largest_order_units
        fewer: NDArray[np.float64] = np.minimum(largest, asked)
        return fewer

    @property
    def end_effect_s(self) -> float:
        """Maximum time that a robot's counted visits and drives take outside the window, in s.

        Before the window, this is at most one drive to a station; after the window, at most the
        service of one unit or bundle and one drive away from a station.
        """
        inbound = np.concatenate([self.picking.inbound_s, self.refill.inbound_s])
        outbound = np.concatenate(
            [
                self.picking.outbound_s + self.picking.unit_pick_s,
                self.refill.outbound_s + self.refill.bundle_transfer_s,
            ]
        )
        return float(inbound.max(initial=0.0) + outbound.max(initial=0.0))


@dataclass(frozen=True)
class Throughput:
    """Counts in the window, of a simulated run or at the optimum of the linear program.

    Attributes
    ----------
    units, visits
        Units picked, and visits of pods, at each pick station, shape (S,).
    lone_units
        The part of the units picked that belongs to orders served completely in one visit, shape
        (S,).
    bundles, refill_visits
        Bundles stored, and visits of pods, at each replenishment station, shape (Q,).
    """

    units: NDArray[np.float64]
    visits: NDArray[np.float64]
    lone_units: NDArray[np.float64]
    bundles: NDArray[np.float64]
    refill_visits: NDArray[np.float64]


def objective(data: RunBound, values: Throughput) -> float:
    """Return the units picked per hour.

    Parameters
    ----------
    data
        The warehouse.
    values
        The counts in the window.
    """
    return float(values.units.sum()) / data.hours
