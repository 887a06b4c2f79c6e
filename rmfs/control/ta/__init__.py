"""Task allocation (TA): which robot does what."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Protocol, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.control.decisions import TaskDecision
    from rmfs.world.robots import Robot

P = TypeVar("P", bound=Parameters)


class Consult(Protocol):
    """What TA may ask the controllers of the other problems, whichever are installed now."""

    def pod_for(self, robot: Robot, station: int) -> int:
        """Ask PPS for a pod that an empty robot should bring to a station of either kind, or -1."""
        ...

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Ask PPS which of several stations a carried pod should serve next."""
        ...

    def place_for(self, robot: Robot) -> int:
        """Ask PSA for an empty place for the pod a robot carries, or -1."""
        ...


class TaskAllocation(Controller[P]):
    """Gives tasks to the robots of `view.asking`, and to those of `view.resting` if it likes.

    Each decision is applied before the next. A robot left without task is asked about again when
    the next trigger happens.
    """

    problem = Problem.TA
    triggers = frozenset({Trigger.START, Trigger.ROBOT_FREE})

    @abstractmethod
    def decide(self, consult: Consult) -> Iterator[TaskDecision]:
        """Yield tasks for robots until nothing is to be given out now."""

    @abstractmethod
    def rest_place(self, robot: Robot) -> int:
        """Choose where an empty robot may rest; -1 for where it is.

        Also asked when a robot at rest has to make room for one that comes for the pod above.
        """
