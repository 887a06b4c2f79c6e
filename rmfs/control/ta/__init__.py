"""Task allocation (TA): which robot does what."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.control.asks import Ask, By
    from rmfs.control.decisions import AssignLines, AssignOrder, Prepare, TaskDecision
    from rmfs.control.repositioning import Move
    from rmfs.world.robots import Robot

P = TypeVar("P", bound=Parameters)


class Consult(Protocol):
    """What TA may ask the controllers of the other problems, whichever are installed now."""

    def serves(self, pod: int, station: int) -> bool:
        """Ask PPS whether there is work for a pod at a station of either kind."""
        ...

    def pod_for(self, robot: Robot, station: int) -> int:
        """Ask PPS for a pod that an empty robot should bring to a station of either kind, or -1."""
        ...

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Ask PPS which of several stations a carried pod should serve next."""
        ...

    def place_for(self, robot: Robot) -> int:
        """Ask PSA for an empty place for the pod a robot carries, or -1."""
        ...

    def may_move(self) -> bool:
        """Whether there is repositioning to be asked at all."""
        ...

    def move_for(self, robot: Robot) -> Move | None:
        """Ask repositioning for a pod that a robot without one should move, and where to."""
        ...


WORK = frozenset(
    {Trigger.ORDER_ASSIGNED, Trigger.ORDER_QUEUED, Trigger.BUNDLE_ASSIGNED, Trigger.POD_AT_HAND}
)
"""Events after which there may be work for robots at rest."""


class TaskAllocation(Controller[P]):
    """Gives tasks to the robots of `view.asking`, and to those of `view.resting` if it likes.

    Each decision is applied before the next. A robot left without task is asked about again when
    the next trigger happens. Robots at rest are to be given work as soon as there is some: rules
    subscribe to the events of `WORK`.
    """

    problem = Problem.TA
    triggers = frozenset({Trigger.START, Trigger.ROBOT_FREE})
    subscriptions = WORK

    @abstractmethod
    def decide(
        self, consult: Consult
    ) -> Iterator[TaskDecision | Prepare | AssignOrder | AssignLines | Ask[Any] | By[Any]]:
        """Yield tasks for robots until nothing is to be given out now.

        A controller that decides POA as well yields orders too, and is also asked when no robot is.
        """

    @abstractmethod
    def rest_place(self, robot: Robot) -> int:
        """Choose where an empty robot may rest; -1 for where it is.

        Also asked when a robot at rest has to make room for one that comes for the pod above.
        """
