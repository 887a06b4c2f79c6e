"""Task allocation (TA): which robot does which task."""

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
    """The questions that TA may ask the controllers currently installed for other problems."""

    def serves(self, pod: int, station: int) -> bool:
        """Ask PPS whether a pod has work at a pick or replenishment station."""
        ...

    def pod_for(self, robot: Robot, station: int) -> int:
        """Ask PPS which pod a robot should fetch and bring to a station; -1 if there is none."""
        ...

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Ask PPS which of several stations a carried pod should serve next."""
        ...

    def place_for(self, robot: Robot) -> int:
        """Ask PSA where to store the pod that a robot carries; -1 if no location is empty."""
        ...

    def may_move(self) -> bool:
        """Return whether the repositioning rule ever moves pods."""
        ...

    def move_for(self, robot: Robot) -> Move | None:
        """Ask the repositioning rule for a move by a robot without a pod; None if there is none."""
        ...


WORK = frozenset(
    {
        Trigger.ORDER_ASSIGNED,
        Trigger.ORDER_QUEUED,
        Trigger.POOL_CHANGED,
        Trigger.BUNDLE_ASSIGNED,
        Trigger.POD_AT_HAND,
    }
)
"""Events after which there may be work for robots at rest."""


class TaskAllocation(Controller[P]):
    """Gives tasks to robots that need one (`view.asking`) or are at rest (`view.resting`).

    Each decision is applied before `decide` is resumed. A robot that gets no task stays in
    `view.asking`, and `decide` is called again at the next trigger. Robots at rest need not get a
    task, but should get work as soon as there is any; therefore rules subscribe to the events of
    `WORK` by default.
    """

    problem = Problem.TA
    triggers = frozenset({Trigger.START, Trigger.ROBOT_FREE})
    subscriptions = WORK

    @abstractmethod
    def decide(
        self, consult: Consult
    ) -> Iterator[TaskDecision | Prepare | AssignOrder | AssignLines | Ask[Any] | By[Any]]:
        """Yield tasks for robots until there is nothing more to assign now.

        A controller that also decides POA yields assignments of orders, too. In this case, `decide`
        is called even if no robot needs a task or is at rest.
        """

    @abstractmethod
    def rest_place(self, robot: Robot) -> int:
        """Choose a waypoint where a robot without a pod may rest; -1 if it should stay.

        The simulation calls this method when a robot at rest beneath a pod must make room for
        another robot, which is to fetch the pod.
        """
