"""Smaller inputs derived from a full one: without irrelevant pods and SKUs, or for a few stations.

`Compact` and `Part` hold such an input, and convert decisions between it and the full input.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rmfs.solvers.models.pile_on.candidates import Candidates
from rmfs.solvers.models.pile_on.data import Flags, Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment


@dataclass(frozen=True)
class Compact:
    """An input without irrelevant pods and SKUs.

    Parameters
    ----------
    full
        The full input.
    data, candidates
        The small input, and its candidate pairs.
    pods
        Index in the full input of each pod of the small input.
    """

    full: PileOn
    data: PileOn
    candidates: Candidates
    pods: Integers

    def expand(self, values: Assignment) -> Assignment:
        """Turn a decision of the small input into one of the full input."""
        pod_station = np.full(self.full.pods, -1)
        pod_robot = np.full(self.full.pods, -1)
        pod_station[self.pods], pod_robot[self.pods] = values.pod_station, values.pod_robot
        return replace(values, pod_station=pod_station, pod_robot=pod_robot)

    def shrink(self, values: Assignment) -> Assignment:
        """Turn a decision of the full input into one of the small input.

        The decision must use only candidate pairs.
        """
        return replace(
            values,
            pod_station=values.pod_station[self.pods],
            pod_robot=values.pod_robot[self.pods],
        )


def compact(data: PileOn, candidates: Candidates) -> Compact:
    """Remove irrelevant pods and SKUs from an input.

    The result contains the SKUs for which there is an order line or a shortage, and the pods that
    may be called, are inbound or are bound to a robot.

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
    """
    kept = candidates.calls.any(axis=1) | (data.inbound >= 0)
    bound = np.zeros(0, dtype=np.int64) if data.robot_pod is None else data.robot_pod
    kept[bound[bound >= 0]] = True
    pods = np.flatnonzero(kept)
    new_pod = np.full(data.pods + 1, -1)
    new_pod[pods] = np.arange(pods.size)
    new_sku = np.full(data.skus, -1)
    new_sku[data.wanted] = np.arange(data.wanted.size)
    small = replace(
        data,
        line_sku=new_sku[data.line_sku],
        stock=data.stock[np.ix_(pods, data.wanted)],
        travel=data.travel[pods],
        available=data.available[pods],
        inbound=data.inbound[pods],
        open_units=data.open_units[:, data.wanted],
        fetch=None if data.fetch is None else data.fetch[:, pods],
        robot_pod=None if data.robot_pod is None else new_pod[data.robot_pod],
    )
    pairs = Candidates(candidates.calls[pods], candidates.places, candidates.fetches[:, pods])
    return Compact(data, small, pairs, pods)


@dataclass(frozen=True)
class Part:
    """The problem of a few stations, with the decisions of all other stations fixed.

    Parameters
    ----------
    full
        The full input.
    values
        The decision of the full input, which stays fixed outside the part.
    data, candidates
        The input of the part, and its candidate pairs.
    stations, orders, robots
        Indices in the full input of the stations, orders and robots of the part.
    kept
        Whether a pod that `values` calls to one of these stations stays called, because an order or
        prospect that stays fixed needs it, shape (P,).
    """

    full: PileOn
    values: Assignment
    data: PileOn
    candidates: Candidates
    stations: Integers
    orders: Integers
    robots: Integers
    kept: Flags

    @property
    def lines(self) -> Integers:
        """Indices in the full input of the lines of the part's orders."""
        return np.flatnonzero(np.isin(self.full.line_order, self.orders))

    def start(self) -> Assignment:
        """Return the part's share of the decision that is in `self.values`."""
        values = self.values
        robot_of = self._numbering(self.robots, self.full.robots)
        station_of = self._numbering(self.stations, self.full.stations)
        pod_station = np.where(self.kept, -1, station_of[values.pod_station])
        inside = pod_station >= 0
        return Assignment(
            slot=values.slot[np.ix_(self.orders, self.stations)],
            line_station=station_of[values.line_station[self.lines]],
            pod_station=pod_station,
            pod_robot=np.where(inside, robot_of[values.pod_robot], -1),
            prospect=station_of[values.prospect[self.orders]],
        )

    def merge(self, values: Assignment) -> Assignment:
        """Return the decision of the full input that contains the given decision of the part."""
        slot, pod_robot = self.values.slot.copy(), self.values.pod_robot.copy()
        slot[np.ix_(self.orders, self.stations)] = values.slot
        line_station, prospect = self.values.line_station.copy(), self.values.prospect.copy()
        line_station[self.lines] = self._station(values.line_station)
        prospect[self.orders] = self._station(values.prospect)
        pod_station = self.values.pod_station.copy()
        own = np.isin(pod_station, self.stations) & ~self.kept | (values.pod_station >= 0)
        pod_station[own] = self._station(values.pod_station[own])
        robots = np.append(self.robots, -1)
        pod_robot[own] = robots[values.pod_robot[own]]
        return Assignment(slot, line_station, pod_station, pod_robot, prospect)

    def _station(self, own: Integers) -> Integers:
        """Stations of the part in the numbering of the full input; -1 stays."""
        full: Integers = np.append(self.stations, -1)[own]
        return full

    @staticmethod
    def _numbering(members: Integers, size: int) -> Integers:
        """Position of each member, -1 for all others and for -1 itself."""
        position = np.full(size + 1, -1)
        position[members] = np.arange(members.size)
        return position


def part(
    data: PileOn, candidates: Candidates, values: Assignment, stations: Integers
) -> Part | None:
    """Return the part in which the decisions of a few stations are free and all others fixed.

    An order that has slots both at a free station and at another one stays fixed. Its slots at the
    free stations remain taken, and its lines covered there become open demand. A pod called to a
    free station stays called if it holds a SKU of such a line. If fixed orders take all slots of a
    free station, the prospects of this station (see `Assignment`) stay fixed, too. As open demand
    need not be covered, a decision returned by `merge` may leave one of these lines without stock.
    Conversely, the part gives stock to open demand first, so its share of `values` may not be
    feasible if `values` leaves open demand of a free station uncovered. `violations` reports both.

    Parameters
    ----------
    data
        The input.
    candidates
        The pairs of pod and station, order and station, and robot and pod that may be used.
    values
        A feasible decision that uses candidate pairs only.
    stations
        The free stations, whose decisions are made anew.

    Returns
    -------
    The part, which contains the orders at these stations, the waiting orders, and the pods and
    robots that no other station uses; None if there is no order to decide on.
    """
    elsewhere = np.ones(data.stations, dtype=np.bool_)
    elsewhere[stations] = False
    outside = np.append(elsewhere, False)
    taken = values.slot[:, elsewhere].any(axis=1) | outside[values.prospect]
    slots, open_units = data.slots[stations], data.open_units[stations]
    called, kept = outside[values.pod_station], np.zeros(data.pods, dtype=np.bool_)
    if data.variant.many_stations:
        slots = slots - values.slot[np.ix_(taken, stations)].sum(axis=0)
        full = np.append(np.zeros(data.stations, dtype=np.bool_), False)
        full[stations] = slots == 0
        taken |= full[values.prospect]
        fixed = _fixed_units(data, values, taken)
        open_units = open_units + fixed[stations]
        serves = (data.stock > 0) & (fixed > 0)[values.pod_station]
        kept = serves.any(axis=1) & (values.pod_station >= 0) & ~called
    orders = np.flatnonzero(~taken & candidates.places[:, stations].any(axis=1))
    if not orders.size:
        return None
    busy = np.zeros(data.robots, dtype=np.bool_)
    away = values.pod_robot[called | kept]
    busy[away[away >= 0]] = True
    robots = np.flatnonzero(~busy)
    lines = np.flatnonzero(np.isin(data.line_order, orders))
    own = Candidates(
        candidates.calls[:, stations] & ~(called | kept)[:, None],
        candidates.places[np.ix_(orders, stations)],
        candidates.fetches[robots],
    )
    station_of = np.full(data.stations + 1, -1)
    station_of[stations] = np.arange(stations.size)
    small = replace(
        data,
        slots=slots,
        line_order=np.searchsorted(orders, data.line_order[lines]),
        line_sku=data.line_sku[lines],
        line_units=data.line_units[lines],
        travel=data.travel[:, stations],
        available=data.available & ~called & ~kept,
        inbound=station_of[np.where(kept, values.pod_station, data.inbound)],
        open_units=open_units,
        fetch=None if data.fetch is None else data.fetch[robots],
        robot_pod=None if data.robot_pod is None else data.robot_pod[robots],
        worth=None if data.worth is None else data.worth[orders],
        may_call=data.callable_to[stations],
    )
    return Part(data, values, small, own, stations, orders, robots, kept)


def _fixed_units(data: PileOn, values: Assignment, fixed: Flags) -> Integers:
    """Units that the lines of fixed orders, and fixed prospects, take at each station, (S, K)."""
    units = np.zeros((data.stations, data.skus), dtype=np.int64)
    for station in (values.line_station, values.prospect[data.line_order]):
        line = np.flatnonzero((station >= 0) & fixed[data.line_order])
        np.add.at(units, (station[line], data.line_sku[line]), data.line_units[line])
    return units
