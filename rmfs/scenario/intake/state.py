"""The part of a run's state on which demand and replenishment may depend."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Site:
    """Those properties of a warehouse that a scenario needs.

    Attributes
    ----------
    pick_stations, replenishment_stations
        How many stations there are, active or not.
    capacity
        Space units of all pods together.
    largest_pod
        Space units of the largest pod.
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
        """Space units stored on all pods."""

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
        """Active pick stations as a share of all; if none is active, one is counted."""

    @property
    def active_replenishment_share(self) -> float:
        """Active replenishment stations as a share of all; if none is active, one is counted."""
