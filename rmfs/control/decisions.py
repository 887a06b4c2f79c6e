"""The decisions that controllers can make; each is applied before the next is made."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.world.charging import ChargeTask
from rmfs.world.tasks import ParkTask, PickTask, ReplenishTask, RepositionTask, RestTask

if TYPE_CHECKING:
    from rmfs.control.choices import Choice
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.robots import Robot
    from rmfs.world.tasks import Task, VisitTask


class AssignOrder(NamedTuple):
    """POA: assign an order of the backlog to a pick station."""

    order: Order
    station: int


class AssignLines(NamedTuple):
    """POA: assign an order's lines for the SKUs in `skus` to a pick station.

    The order is split: its other lines stay in the backlog. If a part of the order is already at
    the station, the lines join that part and share its slot.
    """

    order: Order
    station: int
    skus: tuple[int, ...]


class QueueOrder(NamedTuple):
    """POA: put an order of the backlog into the pool of a pick station.

    The order remains in the backlog and can only be assigned to this station, but its requests can
    already be bound to pods. If `station` is -1, the order is instead removed from its pool, and
    its requests are open again.
    """

    order: Order
    station: int


class SendBundle(NamedTuple):
    """ROA: choose the replenishment station of a bundle, and reserve space at the station."""

    bundle: Bundle
    station: int


class PromiseBundle(NamedTuple):
    """RPS: choose the pod of a bundle, and reserve room in the pod.

    The bundle is released later, by `ReleasePod`.
    """

    bundle: Bundle
    pod: int


class ReleasePod(NamedTuple):
    """RPS: release the bundles promised to a pod.

    A robot can be sent for a bundle once the bundle is released and ROA has chosen its station.
    """

    pod: int


class BringForPicks(NamedTuple):
    """TA: let a robot bring an available pod, or the pod it carries, to a pick station."""

    robot: Robot
    pod: int
    station: int

    def task(self) -> Task:
        """Return the task, not yet begun, that carries out this decision."""
        return PickTask(self.robot.index, self.pod, self.station)


class BringForBundles(NamedTuple):
    """TA: let a robot bring an available pod, or the pod it carries, to a replenishment station."""

    robot: Robot
    pod: int
    station: int

    def task(self) -> Task:
        """Return the task, not yet begun, that carries out this decision."""
        return ReplenishTask(self.robot.index, self.pod, self.station)


class Visit(NamedTuple):
    """TA: let a robot bring an available pod, or the pod it carries, to a station.

    The station is neither a pick nor a replenishment station. `what` is the class of the task,
    which the kind of station determines.
    """

    robot: Robot
    pod: int
    station: int
    what: type[VisitTask]

    def task(self) -> Task:
        """Return the task, not yet begun, that carries out this decision."""
        return self.what(self.robot.index, self.pod, self.station)


class Park(NamedTuple):
    """TA: let a robot store the pod it carries at a storage location (`place`, a waypoint).

    In a `Prepare` decision, `place` may be -1; PSA then chooses the location when the task begins.
    """

    robot: Robot
    place: int

    def task(self) -> Task:
        """Return the task, not yet begun, that carries out this decision."""
        return ParkTask(self.robot.index, place=self.place)


class Reposition(NamedTuple):
    """TA: let a robot fetch an available pod and store it at another, empty storage location."""

    robot: Robot
    pod: int
    place: int

    def task(self) -> Task:
        """Return the task, not yet begun, that carries out this decision."""
        return RepositionTask(self.robot.index, self.pod, place=self.place)


class Rest(NamedTuple):
    """TA: let a robot without a pod wait at a waypoint until TA gives it another task."""

    robot: Robot
    place: int

    def task(self) -> Task:
        """Return the task, not yet begun, that carries out this decision."""
        return RestTask(self.robot.index, place=self.place)


TaskDecision = BringForPicks | BringForBundles | Visit | Park | Reposition | Rest
"""The decisions of TA."""


class WorkFor(NamedTuple):
    """TA, only from a program outside the simulation: let a robot work for a station.

    PPS chooses the pod, unless the robot carries one.
    """

    robot: Robot
    station: int


class Store(NamedTuple):
    """TA, only from a program outside the simulation: let a robot store the pod it carries.

    PSA chooses the storage location.
    """

    robot: Robot


class MovePod(NamedTuple):
    """TA, only from a program outside the simulation: let a robot without a pod move an idle pod.

    Repositioning chooses the pod and its new storage location.
    """

    robot: Robot


class _Ahead(NamedTuple):
    robot: Robot
    tasks: tuple[TaskDecision, ...]


class Prepare(_Ahead):
    """TA: the next tasks of a robot, in order; they replace earlier prepared tasks.

    Prepared tasks reserve nothing. A task is skipped if it is impossible when its turn comes, for
    example because another robot has the pod or has done the work, or because the storage location
    is occupied. After the last prepared task, TA decides about the robot as usual.
    """

    __slots__ = ()
    is_ahead = True  # counts when it is carried out


class Charge(NamedTuple):
    """CA: let a robot without a pod get energy at a station until its battery reaches a level."""

    robot: Robot
    station: int
    until_share: float

    def task(self) -> Task:
        """Return the task, not yet begun, that carries out this decision."""
        return ChargeTask(
            self.robot.index, station=self.station, until_share=float(self.until_share)
        )


class Unplug(NamedTuple):
    """CA: make a charging robot leave its charger; the robot then needs a new task."""

    robot: Robot


class SwitchStation(NamedTuple):
    """SA: switch a station on, so that it may get new work, or off."""

    station: int
    active: bool


class Exchange(NamedTuple):
    """MM: replace the controller of a problem."""

    choice: Choice


Decision = (
    AssignOrder
    | AssignLines
    | QueueOrder
    | SendBundle
    | PromiseBundle
    | ReleasePod
    | TaskDecision
    | WorkFor
    | Store
    | MovePod
    | Prepare
    | Charge
    | Unplug
    | SwitchStation
    | Exchange
)
"""The decisions of all problems."""
