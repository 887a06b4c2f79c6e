"""What controllers may say. Each decision is applied before the controller is resumed."""

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
    """POA: put an order of the backlog on a pick station."""

    order: Order
    station: int


class AssignLines(NamedTuple):
    """POA: put some lines of an order of the backlog on a pick station, those of these SKUs.

    The order is split: the other lines stay in the backlog. Lines of an order that has a part at
    the station already join it, so that it takes one slot there.
    """

    order: Order
    station: int
    skus: tuple[int, ...]


class QueueOrder(NamedTuple):
    """POA: let an order of the backlog join the pool of a pick station.

    It stays in the backlog, but pods can be bound to it; only to this station it can be assigned.
    Station -1 takes it out of the pool it is in; pods bound to it are free of it then.
    """

    order: Order
    station: int


class SendBundle(NamedTuple):
    """ROA: handle a bundle at a replenishment station."""

    bundle: Bundle
    station: int


class PromiseBundle(NamedTuple):
    """RPS: keep room on a pod for a bundle, without releasing the decision yet."""

    bundle: Bundle
    pod: int


class ReleasePod(NamedTuple):
    """RPS: release what was promised to a pod, so that a station can be chosen."""

    pod: int


class BringForPicks(NamedTuple):
    """TA: bring a pod (or go on with the one carried) to a pick station."""

    robot: Robot
    pod: int
    station: int

    def task(self) -> Task:
        """Make of it a task that has not begun."""
        return PickTask(self.robot.index, self.pod, self.station)


class BringForBundles(NamedTuple):
    """TA: bring a pod (or go on with the one carried) to a replenishment station."""

    robot: Robot
    pod: int
    station: int

    def task(self) -> Task:
        """Make of it a task that has not begun."""
        return ReplenishTask(self.robot.index, self.pod, self.station)


class Visit(NamedTuple):
    """Bring a pod (or go on with the one carried) to a station of another kind.

    `what` is the kind of task that the kind of station has.
    """

    robot: Robot
    pod: int
    station: int
    what: type[VisitTask]

    def task(self) -> Task:
        """Make of it a task that has not begun."""
        return self.what(self.robot.index, self.pod, self.station)


class Park(NamedTuple):
    """TA: store the pod the robot carries at a place.

    In a prepared task the place may be -1: PSA is asked when its turn comes.
    """

    robot: Robot
    place: int

    def task(self) -> Task:
        """Make of it a task that has not begun."""
        return ParkTask(self.robot.index, place=self.place)


class Reposition(NamedTuple):
    """TA: fetch a pod that is at hand and store it at another place, which is empty."""

    robot: Robot
    pod: int
    place: int

    def task(self) -> Task:
        """Make of it a task that has not begun."""
        return RepositionTask(self.robot.index, self.pod, place=self.place)


class Rest(NamedTuple):
    """TA: wait at a place."""

    robot: Robot
    place: int

    def task(self) -> Task:
        """Make of it a task that has not begun."""
        return RestTask(self.robot.index, place=self.place)


TaskDecision = BringForPicks | BringForBundles | Visit | Park | Reposition | Rest
"""What TA may decide."""


class WorkFor(NamedTuple):
    """TA, from outside: let a robot work for a station; PPS chooses the pod, if it carries none."""

    robot: Robot
    station: int


class Store(NamedTuple):
    """TA, from outside: let a robot store the pod it carries; PSA chooses the place."""

    robot: Robot


class MovePod(NamedTuple):
    """TA, from outside: let an empty robot move a pod; repositioning chooses pod and place."""

    robot: Robot


class _Ahead(NamedTuple):
    robot: Robot
    tasks: tuple[TaskDecision, ...]


class Prepare(_Ahead):
    """TA: what a robot is to do after its present task, one after another; the last word counts.

    Prepared tasks keep nothing for the robot. One that is impossible when its turn comes (the pod
    is claimed, the place taken, the work done by others) is passed over; after the last one TA is
    asked as usual.
    """

    __slots__ = ()
    is_ahead = True  # counts when it is done


class Charge(NamedTuple):
    """CA: let a robot without pod get energy at a station, until its battery has a level."""

    robot: Robot
    station: int
    until_share: float

    def task(self) -> Task:
        """Make of it a task that has not begun."""
        return ChargeTask(
            self.robot.index, station=self.station, until_share=float(self.until_share)
        )


class Unplug(NamedTuple):
    """CA: let a robot leave the plug-in place where it stands; it needs a task then."""

    robot: Robot


class SwitchStation(NamedTuple):
    """SA: let a station take new work, or stop it."""

    station: int
    active: bool


class Exchange(NamedTuple):
    """MM: install another controller for its problem."""

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
"""What any problem may decide."""
