"""Pod storage assignment (PSA): to which storage location a carried pod goes."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.control.asks import Ask, By
    from rmfs.world.robots import Robot

P = TypeVar("P", bound=Parameters)


class PodStorageAssignment(Controller[P]):
    """Chooses the storage location for a pod that a robot has to store.

    The choice is among the storage locations (`view.storage.places`) that are empty
    (`view.storage.is_empty`). The location is reserved immediately.
    """

    problem = Problem.PSA

    def decide(self) -> Iterator[Ask[Any]]:
        """Yield questions to an optimiser; the base class yields none.

        This method is called only after the events in `subscriptions` and at the times given by
        `next_event_s`.
        """
        return iter(())

    @abstractmethod
    def place(self, robot: Robot) -> int | By[int]:
        """Choose an empty storage location (waypoint) for a robot's pod; -1 if there is none."""

    def least(self, costs: NDArray[np.float64], among: NDArray[np.bool_]) -> int:
        """Find the storage location with the least finite cost.

        Ties go to the location with the lowest waypoint number.

        Parameters
        ----------
        costs, among
            Cost of each of the L storage locations, and whether the location may be chosen; each of
            shape (L,).

        Returns
        -------
        int
            The waypoint of the location; -1 if no location that may be chosen has a finite cost.
        """
        masked = np.where(among, costs, np.inf)
        best = int(masked.argmin())
        return int(self.view.storage.places[best]) if masked[best] < np.inf else -1
