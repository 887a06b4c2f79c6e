"""The part of a run's state on which demand and replenishment may depend."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Site:
    """The properties of a warehouse on which arrivals depend.

    Attributes
    ----------
    pick_stations, replenishment_stations
        Numbers of stations, active or not.
    capacity
        Total capacity of all pods, in space units.
    largest_pod
        Capacity of the largest pod, in space units.
    """

    pick_stations: int
    replenishment_stations: int
    capacity: float
    largest_pod: float


class State(Protocol):
    """The current state of a run, as far as arrivals may depend on it."""

    @property
    def waiting_orders(self) -> int:
        """Number of orders not yet assigned to a pick station."""

    @property
    def waiting_bundles(self) -> int:
        """Number of bundles that lack a station, a pod, or both."""

    @property
    def stored_space(self) -> float:
        """Space units taken by the stored units of all pods."""

    @property
    def load(self) -> float:
        """Space units taken by all stored units and by all bundles that are not stored yet."""

    @property
    def uncommitted(self) -> NDArray[np.int64]:
        """Stored units per SKU minus those that orders still need, shape (K,); may be negative."""

    @property
    def incoming(self) -> NDArray[np.int64]:
        """Units of each SKU in bundles that have arrived and are not stored yet, shape (K,)."""

    @property
    def active_pick_share(self) -> float:
        """Share of the pick stations that are active; at least one station counts as active."""

    @property
    def active_replenishment_share(self) -> float:
        """Share of active replenishment stations; at least one station counts as active."""
