"""Stock on the pods, and space promised on them.

- *contained*: units that are physically on a pod; a unit is subtracted when its pick starts.
- *available*: contained units not yet bound to a request of an order.
- *promised*: space reserved on a pod for bundles to be stored there.

Totals per SKU, loads of pods and the stock inbound to a station depend on these quantities and are
updated in the same operations, so that all of them always agree. Arrays are exposed as read-only
views.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


_SLOTS = 8
"""Initial number of SKUs per pod for which there is room in `skus_on`."""


def read_only(array: NDArray[np.generic]) -> NDArray:  # type: ignore[type-arg]
    """Return a read-only view of an array."""
    view = array.view()
    view.flags.writeable = False
    return view


class Inventory:
    """Stock of K SKUs on P pods.

    The space of a unit is a multiple of 2**-20 space units (see `rmfs.scenario.exact`), so sums of
    spaces are exact in any order and loads never drift.

    Parameters
    ----------
    unit_space
        Space of one unit of each SKU, in space units, shape (K,).
    capacity
        Capacity of each pod, in space units, shape (P,).
    pick_stations
        Number of pick stations.

    Attributes
    ----------
    contained, available
        Units per SKU and pod, shape (K, P). The row of a SKU is contiguous in memory, since rules
        compare all pods for a few SKUs.
    used, promised, load
        Space taken by the units on each pod, space promised on it, and the sum of both, in space
        units, shape (P,).
    inbound
        Available units per SKU on the pods that are at, or on their way to, each pick station,
        shape (S, K).
    uncommitted
        Available units minus ordered units that are not bound yet, per SKU, shape (K,). Negative
        only if orders exceed the stock.
    free_stock
        Available units minus open (not yet bound) units of orders at stations, per SKU, shape
        (K,): the stock left for orders in the backlog.
    ordered
        Units ordered since time zero, shape (K,).
    wanted
        Units ordered and neither picked nor withdrawn, whether bound or not, shape (K,).
    withdrawn_units
        Units ordered and withdrawn before they were picked, of all SKUs.
    total_capacity, stored_space, promised_space
        Sums of `capacity`, `used` and `promised` over all pods, in space units.
    """

    def __init__(
        self,
        unit_space: NDArray[np.float64],
        capacity: NDArray[np.float64],
        pick_stations: int,
    ) -> None:
        skus, pods = len(unit_space), len(capacity)
        # large sites have tens of millions of pairs of SKU and pod
        room = np.iinfo(np.int16).max * unit_space.min(initial=1.0)
        count = np.int16 if capacity.max(initial=0.0) < room else np.int32
        self._contained = np.zeros((skus, pods), count)
        self._available = np.zeros((skus, pods), np.int32)
        self._used = np.zeros(pods)
        self._promised = np.zeros(pods)
        self._load = np.zeros(pods)
        self._inbound = np.zeros((pick_stations, skus), np.int32)
        self._uncommitted = np.zeros(skus, np.int64)
        self._free_stock = np.zeros(skus, np.int64)
        self._ordered = np.zeros(skus, np.int64)
        self._skus_on = np.full((pods, _SLOTS), skus, np.int32)
        self._kinds_on = [0] * pods
        self._wanted = np.zeros(skus, np.int64)
        self.contained: NDArray[np.signedinteger] = read_only(self._contained)
        self.available: NDArray[np.int32] = read_only(self._available)
        self.used: NDArray[np.float64] = read_only(self._used)
        self.promised: NDArray[np.float64] = read_only(self._promised)
        self.load: NDArray[np.float64] = read_only(self._load)
        self.inbound: NDArray[np.int32] = read_only(self._inbound)
        self.uncommitted: NDArray[np.int64] = read_only(self._uncommitted)
        self.free_stock: NDArray[np.int64] = read_only(self._free_stock)
        self.ordered: NDArray[np.int64] = read_only(self._ordered)
        self.wanted: NDArray[np.int64] = read_only(self._wanted)
        self.capacity: NDArray[np.float64] = read_only(capacity.astype(np.float64))
        self.unit_space: NDArray[np.float64] = read_only(unit_space.astype(np.float64))
        self._unit_space_list: list[float] = unit_space.tolist()
        self._inbound_station = [-1] * pods
        self.total_capacity = float(capacity.sum())
        self.stored_space = 0.0
        self.withdrawn_units = 0
        self.promised_space = 0.0

    @property
    def skus_on(self) -> NDArray[np.int32]:
        """The SKUs that each pod contains, in any order, shape (P, M); unused entries are K.

        M grows as needed. If `weights` has one weight per SKU and a final 0,
        `weights[skus_on].sum(axis=1)` is, for each pod, the sum of the weights of its SKUs.
        """
        return read_only(self._skus_on)

    def skus_of(self, pod: int) -> list[int]:
        """Return the SKUs that a pod contains, in any order."""
        skus: list[int] = self._skus_on[pod, : self._kinds_on[pod]].tolist()
        return skus

    def stock(self, pod: int, sku: int, units: int) -> None:
        """Put units, such as the initial stock, on a pod without using promised space."""
        space = units * self._unit_space_list[sku]
        before = self._contained.item(sku, pod)
        if not before and units:
            self._list_sku(pod, sku)
        self._contained[sku, pod] = before + units
        self._available[sku, pod] += units
        self._used[pod] += space
        self._load[pod] += space
        self._uncommitted[sku] += units
        self._free_stock[sku] += units
        self.stored_space += space
        station = self._inbound_station[pod]
        if station >= 0:
            self._inbound[station, sku] += units

    def promise(self, pod: int, space: float) -> None:
        """Reserve space on a pod.

        Raises
        ------
        ValueError
            If the pod has too little space.
        """
        if self._load[pod] + space > self.capacity[pod]:
            raise ValueError(f"pod {pod} has no room for {space:g} space units")
        self._promised[pod] += space
        self._load[pod] += space
        self.promised_space += space

    def withdraw(self, pod: int, space: float) -> None:
        """Cancel a promise of space."""
        self._promised[pod] -= space
        self._load[pod] -= space
        self.promised_space -= space

    def store(self, pod: int, sku: int, units: int) -> None:
        """Put units on a pod, in space that was promised for them."""
        self.withdraw(pod, units * self._unit_space_list[sku])
        self.stock(pod, sku, units)

    def demand(self, sku: int, units: int) -> None:
        """Record the units of a SKU in a new order of the backlog.

        They are added to `ordered` and `wanted`, and subtracted from `uncommitted`.
        """
        self._uncommitted[sku] -= units
        self._wanted[sku] += units
        self._ordered[sku] += units

    def undemand(self, sku: int, units: int) -> None:
        """Record that units of an order in the backlog are withdrawn; `ordered` stays the same."""
        self._uncommitted[sku] += units
        self._wanted[sku] -= units
        self.withdrawn_units += units

    def commit(self, sku: int, units: int) -> None:
        """Subtract units from `free_stock`, or add them if their number is negative.

        The open units of an order are subtracted when the order is assigned to a station. Units
        bound to a pod earlier, while the order is in a station's pool, are subtracted when they are
        bound.
        """
        self._free_stock[sku] -= units

    def bind(self, pod: int, sku: int, units: int) -> None:
        """Bind available units on a pod to requests of orders.

        Raises
        ------
        ValueError
            If the pod has too few available units of the SKU.
        """
        left = self._available[sku, pod] - units
        if left < 0:
            raise ValueError(f"pod {pod} lacks {units} available units of SKU {sku}")
        self._available[sku, pod] = left
        station = self._inbound_station[pod]
        if station >= 0:
            self._inbound[station, sku] -= units

    def unbind(self, pod: int, sku: int, units: int) -> None:
        """Make bound units available again: the pod will not serve their requests."""
        self._available[sku, pod] += units
        station = self._inbound_station[pod]
        if station >= 0:
            self._inbound[station, sku] += units

    def pick(self, pod: int, sku: int) -> None:
        """Remove one unit, which is bound to a request, from a pod."""
        space = self._unit_space_list[sku]
        self._wanted[sku] -= 1
        left = self._contained.item(sku, pod) - 1
        self._contained[sku, pod] = left
        if not left:
            self._unlist_sku(pod, sku)
        self._used[pod] -= space
        self._load[pod] -= space
        self.stored_space -= space

    def begin_inbound(self, pod: int, station: int) -> None:
        """Count the available units of a pod as inbound to a pick station."""
        self._inbound_station[pod] = station
        self._inbound[station] += self._available[:, pod]

    def end_inbound(self, pod: int) -> None:
        """Stop counting the available units of a pod as inbound."""
        self._inbound[self._inbound_station[pod]] -= self._available[:, pod]
        self._inbound_station[pod] = -1

    def serves(self, pod: int, skus: list[int]) -> bool:
        """Whether a unit of any of these SKUs is available on the pod."""
        available = self._available.item
        return any(available(sku, pod) for sku in skus)

    def _list_sku(self, pod: int, sku: int) -> None:
        """Record the first unit of a SKU on a pod."""
        count = self._kinds_on[pod]
        if count == self._skus_on.shape[1]:
            pad = ((0, 0), (0, count))
            self._skus_on = np.pad(self._skus_on, pad, constant_values=len(self._contained))
        self._skus_on[pod, count] = sku
        self._kinds_on[pod] = count + 1

    def _unlist_sku(self, pod: int, sku: int) -> None:
        """Record that the last unit of a SKU has left a pod."""
        row = self._skus_on[pod]
        last = self._kinds_on[pod] - 1
        row[row.tolist().index(sku)] = row[last]
        row[last] = len(self._contained)
        self._kinds_on[pod] = last
