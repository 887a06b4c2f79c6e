"""What demand and replenishment may look at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Site:
    """What a scenario needs to know of the warehouse.

    Attributes
    ----------
    pick_stations, replenishment_stations
        How many there are, active or not.
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
    """The present state of a run, as far as what comes may depend on it."""

    @property
    def waiting_orders(self) -> int:
        """Orders not yet at a station."""

    @property
    def waiting_bundles(self) -> int:
        """Bundles not yet assigned to a station and a pod."""

    @property
    def stored_space(self) -> float:
        """Space units stored on all pods."""

    @property
    def load(self) -> float:
        """Space units of what is stored, on its way into pods, and waiting."""

    @property
    def uncommitted(self) -> NDArray[np.int64]:
        """Units of each SKU stored less those that orders want, shape (K,); may be negative."""

    @property
    def incoming(self) -> NDArray[np.int64]:
        """Units of each SKU in bundles that have come and are not stored yet, shape (K,)."""

    @property
    def active_pick_share(self) -> float:
        """Active pick stations / all of them; one is counted at least."""

    @property
    def active_replenishment_share(self) -> float:
        """Active replenishment stations / all of them; one is counted at least."""
