"""POA near-best-pod: sends each order to the station nearest to the best pod for the order."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.filling import Filling
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.orders import Order
    from rmfs.world.stations import PickStation


class NearBestPodParameters(Parameters):
    """Parameters of POA near-best-pod."""

    metric: Metric = "path"
    """Measure of the distance from pod to station: `euclidean` or `manhattan` (in m), `path`
    (length in m of a loaded robot's shortest path) or `time` (travel time in s of a loaded robot if
    no other robot delays it)."""


class NearBestPod(Filling[NearBestPodParameters]):
    """Sends an order to the station that is nearest to the best pod for the order.

    Orders are assigned in the sequence of their arrival; those that stock cannot serve are skipped.
    The best pods for an order are the stored pods that can supply the most units of the order. The
    station with the shortest distance from one of these pods is chosen. If no stored pod can supply
    a unit, the station with the fewest open orders is chosen. Ties go to the station with the
    lowest number.
    """

    parameters_model = NearBestPodParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the oldest order that stock can serve, and the station nearest to a best pod."""
        order = self.oldest_order()
        if order is None:
            return None
        pods = self._best_pods(order)
        if not len(pods):
            return AssignOrder(order, min(stations, key=lambda s: len(s.orders)).index)
        waypoints = self.view.storage.pod_waypoint[pods]
        away = self.view.travel.distances_to
        nearest = min(
            stations,
            key=lambda s: float(away(s.waypoint, self.parameters.metric)[waypoints].min()),
        )
        return AssignOrder(order, nearest.index)

    def _best_pods(self, order: Order) -> NDArray[np.intp]:
        """Find the stored pods with the most units of an order; none if no pod has any."""
        skus = [line.sku for line in order.lines]
        wanted = np.array([[line.units] for line in order.lines], np.int32)
        units = np.minimum(self.view.inventory.available[skus], wanted).sum(axis=0)
        units *= self.view.storage.is_stored
        most = units.max()
        return (units == most).nonzero()[0] if most else np.empty(0, np.intp)
