"""Pod storage assignment (PSA): which storage place a carried pod goes to."""

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
    """Chooses among the places of `view.storage.places` that are `view.storage.is_empty`.

    It is asked when a robot has to store its pod; the place is reserved immediately.
    """

    problem = Problem.PSA

    def decide(self) -> Iterator[Ask[Any]]:
        """Yield questions for an optimiser; only called after `subscriptions`, by default never."""
        return iter(())

    @abstractmethod
    def place(self, robot: Robot) -> int | By[int]:
        """Choose an empty place (waypoint) for the pod of a robot; -1 if there is none."""

    def least(self, costs: NDArray[np.float64], among: NDArray[np.bool_]) -> int:
        """Find the place with the least finite cost; ties: the lowest waypoint.

        Parameters
        ----------
        costs, among
            Cost of each of the L storage places, and whether it may be chosen, shape (L,).

        Returns
        -------
        int
            The waypoint of the place; -1 if none may be chosen or can be reached.
        """
        masked = np.where(among, costs, np.inf)
        best = int(masked.argmin())
        return int(self.view.storage.places[best]) if masked[best] < np.inf else -1
