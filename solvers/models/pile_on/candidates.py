"""Candidates: pairs (pod and station, order and station, robot and pod) that a method considers.

The *price* of a pod at a station is the cost of calling the pod, divided by the number of order
lines that this pod alone could serve. The price of an order at a station is the total price of the
cheapest pods for the lines that inbound pods do not cover, minus the worth of the order. Pruning
keeps the cheapest few pods per wanted SKU and station, the cheapest few orders per station, the
cheapest few stations per order, and the nearest few robots per pod. A pod that could serve many
lines is cheap and is kept for several SKUs, so few pods remain in total. The loss from pruning is
measured in `tests/benchmarks/test_models_pile_on.py`. A bound of the pruned model is not valid for
the full model; `relaxation.bound` computes a valid one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmfs.solvers.models.checks import flags, integers
from rmfs.solvers.models.pile_on.data import Flags, Floats, Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment


@dataclass(frozen=True)
class Candidates:
    """The pairs that a model may use.

    Parameters
    ----------
    calls
        Whether a pod may be called to a station, shape (P, S).
    places
        Whether an order may be assigned to a station, shape (O, S).
    fetches
        Whether a robot may fetch a pod, shape (R, P).

    Raises
    ------
    ModelError
        If an array does not have two dimensions, or contains values other than 0 and 1.
    """

    calls: Flags
    places: Flags
    fetches: Flags

    def __post_init__(self) -> None:
        for field in ("calls", "places", "fetches"):
            object.__setattr__(self, field, flags(field, getattr(self, field), (None, None)))

    def including(self, values: Assignment) -> Candidates:
        """Return these pairs plus those of a decision, from which a solver can then start.

        Parameters
        ----------
        values
            The decision.
        """
        calls, fetches = self.calls.copy(), self.fetches.copy()
        places = self.places | values.slot
        for table, station in ((calls, values.pod_station), (places, values.prospect)):
            used = np.flatnonzero(station >= 0)
            table[used, station[used]] = True
        fetched = np.flatnonzero(values.pod_robot >= 0)
        fetches[values.pod_robot[fetched], fetched] = True
        return Candidates(calls, places, fetches)


@dataclass(frozen=True)
class Pruning:
    """How many candidates of each kind to keep; more can improve solutions, but take longer.

    Parameters
    ----------
    pods_per_sku
        Number of cheapest pods kept per wanted SKU and station. Default 4.
    orders_per_slot
        Number of cheapest orders kept at a station per free slot. Default 64: for one in twenty of
        150 recorded inputs, the solution is worse than without this limit. With 16, it is worse for
        half of them, by 21 s of robot time on average.
    stations_per_order
        Number of cheapest stations kept for each order, in addition to the stations that keep the
        order as one of their cheapest. Applies only if more stations than this number have free
        slots. Default 4.
    robots_per_pod
        Number of nearest robots kept per pod. Default 4.

    Raises
    ------
    ModelError
        If a number is below 1.
    """

    pods_per_sku: int = 4
    orders_per_slot: int = 64
    stations_per_order: int = 4
    robots_per_pod: int = 4

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            integers(f"pruning.{name}", value, (), low=1)


def everything(data: PileOn) -> Candidates:
    """Return all pairs that can be useful, without pruning.

    These are the pairs of

    - a station to which pods may be called, and an available pod that holds a SKU wanted there;
    - a station with free slots, and any order;
    - a free robot, and an available pod that holds a SKU wanted at any station and needs a robot.

    Parameters
    ----------
    data
        The input.
    """
    on_order = np.zeros(data.skus, dtype=np.bool_)
    on_order[data.line_sku] = True
    takes_orders = data.slots > 0
    wanted = (takes_orders[:, None] & on_order) | (data.shortage > 0)
    # Float products are much faster than boolean ones.
    calls = (data.stock > 0).astype(np.float32) @ wanted.T.astype(np.float32) > 0
    calls &= data.available[:, None]
    places = np.broadcast_to(takes_orders, (data.orders, data.stations))
    return Candidates(calls & data.callable_to, places, _fetches(data, calls))


def prune(data: PileOn, pruning: Pruning | None = None) -> Candidates:
    """Return the pairs that remain after pruning (see the module).

    Parameters
    ----------
    data
        The input.
    pruning
        How many candidates to keep. Default: the defaults of `Pruning`.
    """
    keep = Pruning() if pruning is None else pruning
    if not data.stations:
        return everything(data)
    price = call_price(data)
    pod, column = np.nonzero((data.stock[:, data.wanted] > 0) & data.available[:, None])
    sku = data.wanted[column]
    # Entries by SKU, then price, one row per station; the SKUs are the same in every row.
    order = np.stack([np.lexsort((pod, price[pod, s], sku)) for s in range(data.stations)])
    rank = _rank_in_group(np.sort(sku))
    sku_price = np.full((data.skus, data.stations), np.inf)
    cheapest = order[:, rank == 0]
    stations = np.arange(data.stations)
    sku_price[sku[cheapest], stations[:, None]] = price[pod[cheapest], stations[:, None]]
    places = _best_places(data, _order_price(data, sku_price), keep)
    asked = data.shortage > 0
    line, station = np.nonzero(places[data.line_order])
    asked[station, data.line_sku[line]] = True
    best = order[:, rank < keep.pods_per_sku]
    calls = np.zeros((data.pods, data.stations), dtype=np.bool_)
    station, entry = np.nonzero(asked[stations[:, None], sku[best]])
    calls[pod[best[station, entry]], station] = True
    fetches = np.array(_fetches(data, calls))
    if data.fetch is not None:
        free = data.free_robots
        rank = np.argsort(np.argsort(data.fetch[free], axis=0, kind="stable"), axis=0)
        fetches[free] &= rank < keep.robots_per_pod
    return Candidates(calls & data.callable_to, places, fetches)


def _order_price(data: PileOn, sku_price: Floats) -> Floats:
    """Price of each order at each station, shape (O, S)."""
    missing = data.line_units[:, None] > data.surplus[:, data.line_sku].T
    price = np.where(missing, sku_price[data.line_sku], 0.0)
    if not data.orders:
        return np.zeros((0, data.stations))
    total: Floats = np.add.reduceat(price, data.first_line[:-1], axis=0)
    return total - data.order_worth[:, None]


def _best_places(data: PileOn, price: Floats, keep: Pruning) -> Flags:
    """The cheapest orders of each station and, of many stations, the cheapest of each order."""
    open_price = np.where(data.slots > 0, price, np.inf)
    by_station = np.argsort(np.argsort(open_price, axis=0, kind="stable"), axis=0)
    by_order = np.argsort(np.argsort(open_price, axis=1, kind="stable"), axis=1)
    best = by_station < keep.orders_per_slot * data.slots
    if np.count_nonzero(data.slots) > keep.stations_per_order:
        best |= by_order < keep.stations_per_order
    takes: Flags = best & (data.slots > 0)
    return takes


def call_price(data: PileOn) -> Floats:
    """Return the price of each pod at each station, shape (P, S).

    This is the cost of calling the pod, including the drive of the nearest free robot to the pod,
    divided by the number of order lines that the pod could serve alone.

    Parameters
    ----------
    data
        The input.
    """
    return (data.call_cost + fetch_estimate(data)[:, None]) / np.maximum(_lines(data), 1)[:, None]


def whole_price(data: PileOn) -> Floats:
    """Return the price of completing each order at its cheapest station, shape (O,).

    The price at a station is the sum over the lines of the order. A line costs nothing if the
    surplus of inbound pods covers it. Otherwise, it costs the lowest `call_price` of an available
    pod that holds its SKU, or inf if there is no such pod.

    Parameters
    ----------
    data
        The input.
    """
    price = np.where(data.available[:, None], call_price(data), np.inf)
    cheapest = np.full((data.skus, data.stations), np.inf)
    for sku in np.unique(data.line_sku).tolist():
        cheapest[sku] = price[data.stock[:, sku] > 0].min(axis=0, initial=np.inf)
    missing = data.line_units[:, None] > data.surplus[:, data.line_sku].T
    of_line = np.where(missing, cheapest[data.line_sku], 0.0)
    if not data.orders or not data.stations:
        return np.full(data.orders, np.inf)
    least: Floats = np.add.reduceat(of_line, data.first_line[:-1], axis=0).min(axis=1)
    return least


def fetch_estimate(data: PileOn) -> Floats:
    """Return the weighted travel cost from the nearest free robot to each pod, shape (P,).

    The cost is 0 for pods that need no free robot, and for all pods if no robot is free.

    Parameters
    ----------
    data
        The input.
    """
    if data.fetch is None or not data.free_robots.size:
        return np.zeros(data.pods)
    nearest = data.fetch[data.free_robots].min(axis=0)
    return np.where(data.needs_robot, data.weights.travel * nearest, 0.0)


def _lines(data: PileOn) -> Integers:
    """Number of order lines that a pod could serve alone, shape (P,)."""
    # Lines of the same SKU and units are counted together.
    kinds, count = np.unique(np.stack([data.line_sku, data.line_units]), axis=1, return_counts=True)
    enough = data.stock[:, kinds[0]] >= kinds[1]
    lines: Integers = enough @ count
    return lines


def _fetches(data: PileOn, calls: Flags) -> Flags:
    """Which free robots may fetch the pods that may be called, shape (R, P)."""
    fetches = np.zeros((data.robots, data.pods), dtype=np.bool_)
    fetches[data.free_robots] = calls.any(axis=1) & data.needs_robot
    return fetches


def _rank_in_group(group: Integers) -> Integers:
    """Position of each element within its run of equal values."""
    index = np.arange(group.size)
    starts = np.flatnonzero(np.diff(group, prepend=-1))
    rank: Integers = index - np.repeat(starts, np.diff(np.append(starts, group.size)))
    return rank
