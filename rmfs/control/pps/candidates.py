"""Pods that could be brought to a station, and the work that they could do there."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.traffic import _core as compiled  # the package has one compiled library

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.pps import Requests
    from rmfs.control.view import View
    from rmfs.world.orders import Order
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation


class Candidates:
    """C pods that a robot could bring to a station.

    Attributes
    ----------
    pods
        Numbers of the pods, in ascending order, shape (C,).
    """

    def __init__(
        self,
        view: View,
        robot: Robot,
        station: PickStation | ReplenishmentStation,
        pods: NDArray[np.intp],
    ) -> None:
        self.view = view
        self.robot = robot
        self.station = station
        self.pods = pods

    def __len__(self) -> int:
        return len(self.pods)

    def narrowed(self, to: NDArray[np.intp]) -> Candidates:
        """Return a copy that keeps only some candidates; `to` contains their indices in `pods`."""
        return Candidates(self.view, self.robot, self.station, self.pods[to])

    def waypoints(self) -> NDArray[np.int32]:
        """Return the waypoints at which the pods are stored, shape (C,)."""
        return self.view.storage.pod_waypoint[self.pods]

    def other_tiers(self) -> NDArray[np.int64] | int:
        """Return, for each pod, 1 if the robot is on another tier, plus 1 if the station is.

        The shape is (C,). If the warehouse has a single tier, the result is the number 0 instead of
        an array.
        """
        travel = self.view.travel
        if travel.tiers == 1:
            return 0
        tier = travel.tier[self.waypoints()]
        away: NDArray[np.int64] = (tier != self.robot.tier).astype(np.int64)
        away += tier != self.station.tier
        return away


class Completed(NamedTuple):
    """Which orders each of C pods completes.

    Attributes
    ----------
    orders
        The O orders with open requests; those assigned to the station come first.
    assigned
        How many of `orders` are assigned to the station; the others are in its pool (queued).
    flags
        Whether an order is completed by a pod (`PickCandidates.completed`), shape (O, C).
    """

    orders: Sequence[Order]
    assigned: int
    flags: NDArray[np.bool_]

    def weighed(self, weights: Sequence[float], queued: bool) -> NDArray[np.float64]:
        """Return the total weight of the orders that each pod completes, shape (C,).

        Parameters
        ----------
        weights
            Weight of each of the O orders.
        queued
            Whether to count the queued orders instead of the assigned orders.
        """
        part = slice(self.assigned, None) if queued else slice(self.assigned)
        # a sum over rows, in their order: repeats on every machine
        total: NDArray[np.float64] = (
            self.flags[part] * np.array(weights[part], float)[:, None]
        ).sum(axis=0)
        return total


class PickCandidates(Candidates):
    """Candidates for a pick station.

    Parameters
    ----------
    skus
        The S SKUs with open requests at the station and, if queued orders count, in its pool.
    have
        Available units of each SKU on each candidate, shape (S, C).
    queued
        The orders in the station's pool (queued orders) whose requests count.
    requests
        Which orders' requests count (`rmfs.control.pps.Requests`).
    """

    def __init__(
        self,
        view: View,
        robot: Robot,
        station: PickStation,
        pods: NDArray[np.intp],
        skus: list[int],
        have: NDArray[np.int32],
        queued: Sequence[Order] = (),
        requests: Requests = "assigned",
    ) -> None:
        super().__init__(view, robot, station, pods)
        self.pick_station = station
        self.skus = skus
        self.have = have
        self.queued = queued
        self.requests = requests
        self._completed: Completed | None = None

    def narrowed(self, to: NDArray[np.intp]) -> PickCandidates:
        """Return a copy that keeps only some candidates; `to` contains their indices in `pods`."""
        kept = PickCandidates(
            self.view,
            self.robot,
            self.pick_station,
            self.pods[to],
            self.skus,
            self.have[:, to],
            self.queued,
            self.requests,
        )
        if self._completed is not None:
            kept._completed = self._completed._replace(flags=self._completed.flags[:, to])
        return kept

    def servable_units(self) -> NDArray[np.int64]:
        """Return how many open requests of assigned orders each pod can serve, shape (C,)."""
        need = self.view.need[self.station.index][self.skus]
        units: NDArray[np.int64] = np.minimum(self.have, need[:, None]).sum(axis=0)
        return units

    def queued_units(self) -> NDArray[np.int64]:
        """Return how many open requests of queued orders each pod can serve, shape (C,).

        If `requests` is `assigned-and-completable`, only the queued orders that the pod completes
        count (see `completed`). Otherwise, queued orders get the units that assigned orders leave
        on the pod.
        """
        if self.requests == "assigned-and-completable":
            done = self.completed()
            units = [float(order.open_units) for order in done.orders]
            return done.weighed(units, queued=True).astype(np.int64)
        need = self.view.need[self.station.index][self.skus]
        queued_need = self.view.queued_need[self.station.index][self.skus]
        left = self.have - np.minimum(self.have, need[:, None])
        served: NDArray[np.int64] = np.minimum(left, queued_need[:, None]).sum(axis=0)
        return served

    def completed(self) -> Completed:
        """Return, for each pod, which orders it completes by serving all of their open requests.

        Assigned orders are considered in the sequence of their assignment, then queued orders in
        the sequence in which they joined the pool. An order takes units from the pod only if the
        pod has all units left that the order still needs. Orders without open requests do not
        count.
        """
        if self._completed is None:
            self._completed = self._find_completed()
        return self._completed

    def _find_completed(self) -> Completed:
        row_of = {sku: row for row, sku in enumerate(self.skus)}
        assigned = [order for order in self.pick_station.orders.values() if order.open_units]
        orders = [*assigned, *self.queued]
        wanted = [
            [(row_of[line.sku], line.open_units) for line in order.lines if line.open_units]
            for order in orders
        ]
        return Completed(orders, len(assigned), compiled.completed(self.have, wanted))


def pick_candidates(
    view: View, robot: Robot, station: PickStation, requests: Requests = "assigned"
) -> PickCandidates:
    """Find the available pods that can serve an open request of a pick station.

    Parameters
    ----------
    requests
        Which orders' requests count. Queued orders do not count if the station has no free slot,
        because the pod might arrive before a slot is free.
    """
    skus = list(station.requests.lines)
    queued: list[Order] = []
    if requests != "assigned" and station.queued and station.free_slots:
        queued = [order for order in station.queued.values() if order.open_units]
    if queued:
        skus += [sku for sku in station.queued_requests.lines if sku not in station.requests.lines]
    if not skus:
        none = np.empty(0, np.intp)
        return PickCandidates(view, robot, station, none, skus, np.empty((0, 0), np.int32))
    have = view.inventory.available[skus]
    assigned = len(station.requests.lines) if requests == "assigned-and-completable" else len(skus)
    # with requests of queued orders only, no row is left, and no pod is useful yet
    useful = np.maximum.reduce(have[:assigned], axis=0, initial=0) > 0
    if requests == "assigned-and-completable":
        for order in queued:
            useful |= _covered(view, order)
    useful &= view.storage.is_at_hand
    pods = useful.nonzero()[0]
    return PickCandidates(view, robot, station, pods, skus, have[:, pods], queued, requests)


def _covered(view: View, order: Order) -> NDArray[np.bool_]:
    """Whether each pod has all units available that an order still wants, shape (P,)."""
    lines = [line for line in order.lines if line.open_units]
    available = view.inventory.available
    covered: NDArray[np.bool_] = available[lines[0].sku] >= lines[0].open_units
    for line in lines[1:]:
        covered &= available[line.sku] >= line.open_units
    return covered


def replenishment_candidates(view: View, robot: Robot, station: ReplenishmentStation) -> Candidates:
    """Find the available pods for which bundles wait at a replenishment station."""
    if not station.waiting:
        return Candidates(view, robot, station, np.empty(0, np.intp))
    waiting = view.bundles_waiting[station.number]
    useful = waiting > 0
    useful &= view.storage.is_at_hand
    return Candidates(view, robot, station, useful.nonzero()[0])
