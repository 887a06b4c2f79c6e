r"""The problem: each station gets as many orders as it has slots, and pods with enough units.

.. math::

    \min \sum_{ps} y_{ps}, \quad \sum_o x_{os} = C_s, \quad \sum_s x_{os} \le 1, \quad
    \sum_s y_{ps} \le 1, \quad \sum_p stock_{pk}\, y_{ps} \ge \sum_o units_{ok}\, x_{os}

for all orders o, pods p, stations s and SKUs k, where :math:`y_{ps}` is 1 if pod p goes to station
s, :math:`x_{os}` is 1 if order o goes to station s, and :math:`C_s` is the number of slots (Valle
and Beasley 2021, who speak of racks and pickers). There may be more orders than slots, but every
slot must be filled. Unlike the model `rmfs.solvers.models.pile_on`, this model is static: it has no
pods under way, no travel and no empty slots.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import integers

NONE = -1
"""Station of an order or pod that is assigned to no station."""


@dataclass(frozen=True)
class RackAllocation:
    """Orders, pods and stations.

    Parameters
    ----------
    units
        Units of each SKU that each order asks for, shape (O, K).
    stock
        Units of each SKU on each pod, shape (P, K).
    slots
        Number of orders that each station takes, shape (S,).

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    units: NDArray[np.int64]
    stock: NDArray[np.int64]
    slots: NDArray[np.int64]

    def __post_init__(self) -> None:
        units = integers("units", self.units, (None, None), low=0)
        object.__setattr__(self, "units", units)
        stock = integers("stock", self.stock, (None, units.shape[1]), low=0)
        object.__setattr__(self, "stock", stock)
        object.__setattr__(self, "slots", integers("slots", self.slots, (None,), low=0))

    @cached_property
    def lines(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Order and SKU of each order line, both shape (L,)."""
        order, sku = np.nonzero(self.units)
        return order, sku

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Numbers of orders, pods and stations."""
        return len(self.units), len(self.stock), len(self.slots)


@dataclass(frozen=True)
class Allocation:
    """The station of each order and pod.

    Attributes
    ----------
    order_station
        Station of each order, or `NONE`, shape (O,).
    pod_station
        Station of each pod, or `NONE`, shape (P,).
    """

    order_station: NDArray[np.int64]
    pod_station: NDArray[np.int64]


def objective(data: RackAllocation, allocation: Allocation) -> float:
    """Return the number of pods used.

    Parameters
    ----------
    data
        The problem.
    allocation
        The station of each order and pod.
    """
    return float((allocation.pod_station != NONE).sum())


def pods_needed(data: RackAllocation) -> float:
    """Return a lower bound on the number of pods.

    The bound is the number of stations that must get an order with lines. Orders without lines need
    no pod; in the best case, they fill the stations with the fewest slots.

    Parameters
    ----------
    data
        The problem.
    """
    nothing = int((~data.units.any(axis=1)).sum())
    return float((np.sort(data.slots).cumsum() > nothing).sum())


def violations(data: RackAllocation, allocation: Allocation) -> list[str]:
    """Return a message for each violation found; an empty list if the allocation is feasible.

    Parameters
    ----------
    data
        The problem.
    allocation
        The station of each order and pod.
    """
    orders, pods, stations = data.sizes
    for name, chosen, count in (
        ("order", allocation.order_station, orders),
        ("pod", allocation.pod_station, pods),
    ):
        if chosen.shape != (count,) or not ((chosen >= NONE) & (chosen < stations)).all():
            return [f"{name}_station must have a station or -1 for each {name}"]
    found = []
    given = np.bincount(
        allocation.order_station[allocation.order_station != NONE], minlength=stations
    )
    if (given != data.slots).any():
        found.append("a station gets more or fewer orders than it has slots")
    for station in range(stations):
        asked = data.units[allocation.order_station == station].sum(axis=0)
        there = data.stock[allocation.pod_station == station].sum(axis=0)
        if (asked > there).any():
            found.append(f"station {station} lacks units")
    return found
