"""Pods that could be brought to a station, with what they could do there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation


class Candidates:
    """C pods a robot could bring to a station.

    Attributes
    ----------
    pods
        Pods, ascending, shape (C,).
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
        """Keep only some of the pods, given by position."""
        return Candidates(self.view, self.robot, self.station, self.pods[to])

    def waypoints(self) -> NDArray[np.int32]:
        """Where the pods are stored, shape (C,)."""
        return self.view.storage.pod_waypoint[self.pods]

    def other_tiers(self) -> NDArray[np.int64] | int:
        """How many of robot and station are on another tier than the pod, shape (C,) or 0."""
        travel = self.view.travel
        if travel.tiers == 1:
            return 0
        tier = travel.tier[self.waypoints()]
        away: NDArray[np.int64] = (tier != self.robot.tier).astype(np.int64)
        away += tier != self.station.tier
        return away


class PickCandidates(Candidates):
    """Candidates for a pick station.

    Parameters
    ----------
    skus
        The S SKUs with open requests at the station.
    have
        Units available of each of them on the candidates, shape (S, C).
    """

    def __init__(
        self,
        view: View,
        robot: Robot,
        station: PickStation,
        pods: NDArray[np.intp],
        skus: list[int],
        have: NDArray[np.int32],
    ) -> None:
        super().__init__(view, robot, station, pods)
        self.pick_station = station
        self.skus = skus
        self.have = have
        self._completed: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None

    def narrowed(self, to: NDArray[np.intp]) -> PickCandidates:
        """Keep only some of the pods, given by position."""
        kept = PickCandidates(
            self.view, self.robot, self.pick_station, self.pods[to], self.skus, self.have[:, to]
        )
        if self._completed is not None:
            orders, units = self._completed
            kept._completed = orders[to], units[to]
        return kept

    def servable_units(self) -> NDArray[np.int64]:
        """Open requests each pod can serve, shape (C,)."""
        need = self.view.need[self.station.index][self.skus]
        units: NDArray[np.int64] = np.minimum(self.have, need[:, None]).sum(axis=0)
        return units

    def completed(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Orders of the station whose open requests each pod covers, and units of these, (C,) each.

        Orders are gone through as they were assigned, and each takes what it needs of the pod's
        available units if all is there. Orders without open requests count for nothing (in
        RAWSim-O for one on every pod, which changes no comparison).
        """
        if self._completed is None:
            self._completed = self._count_completed()
        return self._completed

    def _count_completed(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        row_of = {sku: row for row, sku in enumerate(self.skus)}
        left = self.have.copy()
        orders = np.zeros(len(self.pods), np.int64)
        units = np.zeros(len(self.pods), np.int64)
        for order in self.pick_station.orders.values():
            if not order.open_units:
                continue
            wanted = [(row_of[ln.sku], ln.open_units) for ln in order.lines if ln.open_units]
            row, count = wanted[0]
            covered = left[row] >= count
            for row, count in wanted[1:]:
                covered &= left[row] >= count
            orders += covered
            units += covered * order.open_units
            for row, count in wanted:
                left[row] -= covered * np.int32(count)
        return orders, units


def pick_candidates(view: View, robot: Robot, station: PickStation) -> PickCandidates:
    """Find the pods at hand that can serve an open request of a pick station."""
    skus = list(station.requests.lines)
    if not skus:
        none = np.empty(0, np.intp)
        return PickCandidates(view, robot, station, none, skus, np.empty((0, 0), np.int32))
    have = view.inventory.available[skus]
    useful = have.max(axis=0) > 0
    useful &= view.storage.is_at_hand
    pods = useful.nonzero()[0]
    return PickCandidates(view, robot, station, pods, skus, have[:, pods])


def replenishment_candidates(view: View, robot: Robot, station: ReplenishmentStation) -> Candidates:
    """Find the pods at hand for which bundles wait at a replenishment station."""
    if not station.waiting:
        return Candidates(view, robot, station, np.empty(0, np.intp))
    waiting = view.bundles_waiting[station.index - len(view.pick_stations)]
    useful = waiting > 0
    useful &= view.storage.is_at_hand
    return Candidates(view, robot, station, useful.nonzero()[0])
