"""Pod storage assignment (PSA): which storage place a carried pod goes to."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem

if TYPE_CHECKING:
    from rmfs.world.robots import Robot

P = TypeVar("P", bound=Parameters)


class PodStorageAssignment(Controller[P]):
    """Chooses among the places of `view.storage.places` that are `view.storage.is_empty`.

    It is asked when a robot has to store its pod; the place is kept for it at once.
    """

    problem = Problem.PSA

    @abstractmethod
    def place(self, robot: Robot) -> int:
        """Choose an empty place (waypoint) for the pod a robot carries; -1 if there is none."""
