"""Turnover classes, which match fast-moving pods and SKUs with locations near pick stations."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.trackers import Tracker
from rmfs.control.trackers.frequency import Frequency
from rmfs.control.travel import Metric

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View


class TurnoverParameters(Parameters):
    """Parameters of turnover classes; they must be equal in rules that work together (RPS, PSA)."""

    class_borders: Annotated[tuple[float, ...], pydantic.Field(min_length=1)] = (0.1, 0.3, 1.0)
    """Borders of the turnover classes, as cumulative shares of the storage locations, nearest to a
    pick station first. With [0.1, 0.3, 1.0], the first class has the nearest 10 % of the locations,
    the second class the next 20 %, and the last class all others. The last border must be 1."""
    place_metric: Metric = "time"
    """Measure of the distance from a storage location to its nearest pick station: `euclidean` or
    `manhattan` (in m), `path` (length in m of a loaded robot's shortest path) or `time` (travel
    time in s of a loaded robot if no other robot delays it)."""
    reallocation_period_s: Annotated[float, pydantic.Field(ge=0)] = 0.0
    """Pods and SKUs are reclassified when this many seconds have passed since the last
    classification. With 0, the time does not matter."""
    reallocation_orders: Annotated[int, pydantic.Field(ge=0)] = 0
    """Pods and SKUs are reclassified when this many orders have arrived since the last
    classification. With 0, the number of orders does not matter."""

    @pydantic.field_validator("class_borders")
    @classmethod
    def _ascending(cls, value: tuple[float, ...]) -> tuple[float, ...]:
        if value[-1] != 1 or value[0] <= 0 or any(a >= b for a, b in pairwise(value)):
            raise ValueError("must ascend from above 0 to 1, for example [0.1, 0.3, 1.0]")
        return value

    @classmethod
    def of(cls, parameters: TurnoverParameters) -> TurnoverParameters:
        """Extract the `TurnoverParameters` from a rule's parameters, which include them."""
        names = TurnoverParameters.model_fields
        return TurnoverParameters(**{name: getattr(parameters, name) for name in names})


class TurnoverClasses(Tracker):
    """Classes of storage locations, pods and SKUs, from 0, the fastest, to `classes` - 1.

    - Storage locations are sorted by distance to the nearest pick station and divided at the class
      borders; the number of locations up to a border is rounded down.
    - Pods are sorted by the number of units ordered, averaged over the SKUs on the pod, the highest
      first. Ties are broken by distance to the nearest pick station, then by number. The pods are
      divided among the classes in proportion to the number of locations in each class.
    - SKUs are sorted by units ordered, the most ordered first; ties are broken by number. The
      weight of a SKU is the mean of two shares: its share of all units ordered, and its share of
      the total space of one unit of each SKU. A class takes SKUs until the total weight of the
      SKUs in this and faster classes reaches a limit: the capacity of the pods in these classes, as
      a share of the capacity of all pods.

    Pods and SKUs are classified when a rule first requests the tracker. They are reclassified on
    the first access after `reallocation_period_s` have passed, or `reallocation_orders` orders have
    arrived, since the last classification. The first classification counts all units ordered so
    far, including those of orders from before the run; later ones count the units ordered since the
    previous classification. Locations keep their class.

    Attributes
    ----------
    classes
        Number of classes.
    place_class
        Class of each of the L storage locations, shape (L,).
    """

    def __init__(self, view: View, parameters: TurnoverParameters) -> None:
        super().__init__(view)
        self.parameters = parameters
        self.classes = len(parameters.class_borders)
        self._frequency = view.trackers.get(Frequency)
        self._distance = np.min(
            [
                view.travel.distances_to(station.waypoint, parameters.place_metric)
                for station in view.pick_stations
            ],
            axis=0,
        )
        places = view.storage.places
        self._place_ends = [int(b * len(places) + 1e-9) for b in parameters.class_borders]
        nearest_first = np.argsort(self._distance[places], kind="stable")
        self.place_class = _cut(nearest_first, self._place_ends)
        self._counted = np.zeros(len(view.skus), np.int64)
        self._class_anew()

    @property
    def pod_class(self) -> NDArray[np.int64]:
        """Class of each pod, shape (P,)."""
        self._keep_up()
        return self._pod_class

    @property
    def sku_class(self) -> NDArray[np.int64]:
        """Class of each SKU, shape (K,)."""
        self._keep_up()
        return self._sku_class

    def _keep_up(self) -> None:
        """Reclassify pods and SKUs if this is due."""
        given, view = self.parameters, self.view
        late = 0 < given.reallocation_period_s <= view.now_s - self._classed_s
        if late or 0 < given.reallocation_orders <= view.orders_created - self._classed_orders:
            self._class_anew()

    def _class_anew(self) -> None:
        self._classed_s = self.view.now_s
        self._classed_orders = self.view.orders_created
        units = self._frequency.units
        ordered = units - self._counted
        self._counted = units
        self._pod_class = self._class_pods(ordered)
        self._sku_class = self._class_skus(ordered)

    def _class_pods(self, ordered: NDArray[np.int64]) -> NDArray[np.int64]:
        skus_on = self.view.inventory.skus_on
        kinds = (skus_on < len(ordered)).sum(axis=1)
        speed = np.append(ordered, 0)[skus_on].sum(axis=1) / np.maximum(kinds, 1)
        distance = self._distance[self.view.storage.pod_waypoint]
        fastest_first = np.lexsort((distance, -speed))
        pods, places = len(kinds), self._place_ends[-1]
        return _cut(fastest_first, [pods * end // places for end in self._place_ends])

    def _class_skus(self, ordered: NDArray[np.int64]) -> NDArray[np.int64]:
        # spaces and capacities are multiples of a power of two: sums are exact in any order
        space = self.view.skus.space_per_unit
        shares = (ordered / max(int(ordered.sum()), 1) + space / space.sum()) / 2
        most_first = np.argsort(-ordered, kind="stable")
        before = np.cumsum(shares[most_first]) - shares[most_first]
        capacity = self.view.inventory.capacity
        in_class = np.bincount(self._pod_class, weights=capacity, minlength=self.classes)
        borders = np.cumsum(in_class / capacity.sum())[:-1]
        sku_class = np.empty(len(ordered), np.int64)
        sku_class[most_first] = np.searchsorted(borders, before, side="right")
        return sku_class


def _cut(in_order: NDArray[np.intp], ends: list[int]) -> NDArray[np.int64]:
    """Return the class of each of n items: 0 for the first `ends[0]` of `in_order`, and so on."""
    classes = np.empty(len(in_order), np.int64)
    classes[in_order] = np.searchsorted(ends, np.arange(len(in_order)), side="right")
    return classes
