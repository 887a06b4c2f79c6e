"""The decisions that controllers can make; each is applied before the controller is resumed."""

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
    """POA: assign the lines of an order with these SKUs to a pick station.

    The order is split: its other lines stay in the backlog. Lines of an order that already has a
    part at the station join that part and share its slot.
    """

    order: Order
    station: int
    skus: tuple[int, ...]


class QueueOrder(NamedTuple):
    """POA: move an order of the backlog into the pool of a pick station.

    The order remains in the backlog and can only be assigned to this station, but its requests can
    be bound to pods. Station -1 removes it from its pool and makes these requests open again.
    """

    order: Order
    station: int


class SendBundle(NamedTuple):
    """ROA: choose the replenishment station of a bundle, and reserve space there."""

    bundle: Bundle
    station: int


class PromiseBundle(NamedTuple):
    """RPS: choose the pod of a bundle, which reserves room; not released until `ReleasePod`."""

    bundle: Bundle
    pod: int


class ReleasePod(NamedTuple):
    """RPS: release the bundles promised to a pod, after which ROA and TA may act on the choice."""

    pod: int


class BringForPicks(NamedTuple):
    """TA: bring an available pod, or the one already carried, to a pick station."""

    robot: Robot
    pod: int
    station: int

    def task(self) -> Task:
        """Return the corresponding task, not yet begun."""
        return PickTask(self.robot.index, self.pod, self.station)


class BringForBundles(NamedTuple):
    """TA: bring an available pod, or the one already carried, to a replenishment station."""

    robot: Robot
    pod: int
    station: int

    def task(self) -> Task:
        """Return the corresponding task, not yet begun."""
        return ReplenishTask(self.robot.index, self.pod, self.station)


class Visit(NamedTuple):
    """TA: bring an available pod, or the one already carried, to a station of another kind.

    `what` is the kind of task, as defined by the kind of station.
    """

    robot: Robot
    pod: int
    station: int
    what: type[VisitTask]

    def task(self) -> Task:
        """Return the corresponding task, not yet begun."""
        return self.what(self.robot.index, self.pod, self.station)


class Park(NamedTuple):
    """TA: store the carried pod at a place.

    In a prepared task the place may be -1: PSA then chooses the place when the task begins.
    """

    robot: Robot
    place: int

    def task(self) -> Task:
        """Return the corresponding task, not yet begun."""
        return ParkTask(self.robot.index, place=self.place)


class Reposition(NamedTuple):
    """TA: fetch an available pod and store it at another, empty place."""

    robot: Robot
    pod: int
    place: int

    def task(self) -> Task:
        """Return the corresponding task, not yet begun."""
        return RepositionTask(self.robot.index, self.pod, place=self.place)


class Rest(NamedTuple):
    """TA: wait at a waypoint without a pod; TA may give the robot another task at any time."""

    robot: Robot
    place: int

    def task(self) -> Task:
        """Return the corresponding task, not yet begun."""
        return RestTask(self.robot.index, place=self.place)


TaskDecision = BringForPicks | BringForBundles | Visit | Park | Reposition | Rest
"""The decisions of TA."""


class WorkFor(NamedTuple):
    """TA, from outside: let a robot work for a station.

    PPS chooses the pod, unless the robot carries one.
    """

    robot: Robot
    station: int


class Store(NamedTuple):
    """TA, from outside: let a robot store the pod it carries; PSA chooses the place."""

    robot: Robot


class MovePod(NamedTuple):
    """TA, from outside: let a robot without a pod move an idle one.

    Repositioning chooses pod and place.
    """

    robot: Robot


class _Ahead(NamedTuple):
    robot: Robot
    tasks: tuple[TaskDecision, ...]


class Prepare(_Ahead):
    """TA: the next tasks of a robot, in order; they replace earlier prepared tasks.

    Prepared tasks reserve nothing. A task that is impossible when its turn comes (the pod is
    claimed, the place occupied, the work done by others) is skipped; after the last one, TA is
    asked as usual.
    """

    __slots__ = ()
    is_ahead = True  # counts when it is carried out


class Charge(NamedTuple):
    """CA: send a robot without a pod to an energy station, until its battery reaches a level."""

    robot: Robot
    station: int
    until_share: float

    def task(self) -> Task:
        """Return the corresponding task, not yet begun."""
        return ChargeTask(
            self.robot.index, station=self.station, until_share=float(self.until_share)
        )


class Unplug(NamedTuple):
    """CA: make a robot leave its plug-in place; it then needs a task."""

    robot: Robot


class SwitchStation(NamedTuple):
    """SA: switch a station on (it may get new work) or off."""

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
