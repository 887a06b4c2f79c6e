"""Tasks of robots: one class for each kind of task.

Every task takes a robot, with or without a pod, to a station or to a storage location (*place*); a
robot may also rest at another waypoint. A kind of task defines when a task is possible, what the
world reserves when the task starts, and what the world releases when the task ends.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol

if TYPE_CHECKING:
    from rmfs.world.inventory import Inventory
    from rmfs.world.orders import Bundle, OrderLine
    from rmfs.world.robots import Robot
    from rmfs.world.storage import Storage


class Serves(Protocol):
    """Function that returns whether there is work for a pod at a station."""

    def __call__(self, pod: int, station: int) -> bool:
        """Return whether there is work for the pod at the station."""
        ...


class Keeps(Protocol):
    """The operations with which tasks reserve pods, places and work in the world."""

    robots: list[Robot]
    storage: Storage
    inventory: Inventory
    stations: list[Any]

    def start_pick(self, robot: Robot, pod: int, station: int) -> PickTask:
        """Start the task of bringing a pod to a pick station."""
        ...

    def start_replenish(self, robot: Robot, pod: int, station: int) -> ReplenishTask:
        """Start the task of bringing a pod to a replenishment station."""
        ...

    def start_visit(self, task: VisitTask) -> VisitTask:
        """Start bringing a pod to a station other than a pick or replenishment station."""
        ...

    def start_charge(self, task: Any) -> Task:
        """Start the task of going to a charger or swap station."""
        ...

    def start_park(self, robot: Robot, place: int) -> Task:
        """Start the task of storing the carried pod at a place."""
        ...

    def start_reposition(self, robot: Robot, pod: int, place: int) -> Task:
        """Start the task of moving a stored pod to another place."""
        ...

    def start_rest(self, robot: Robot, place: int) -> Task:
        """Start the task of resting at a place."""
        ...


class Pick(NamedTuple):
    """A unit to be picked from a pod, and whether it was bound after the pod's task had begun."""

    line: OrderLine
    late_bound: bool


@dataclass(slots=True, eq=False)
class Task:
    """One task of one robot.

    Attributes
    ----------
    kind
        Name of this kind of task in tables, traces and the viewer.
    rests
        Whether a robot with this task may get another task at any time.
    robot
        Index of the robot.
    pod
        The pod to be brought or stored; -1 for none.
    station
        The station to which the robot goes; -1 for none.
    place
        The waypoint at which the pod is to be stored or the robot is to rest; -1 for none, or if it
        has not been chosen yet.
    """

    kind: ClassVar[str]
    rests: ClassVar[bool] = False

    robot: int
    pod: int = -1
    station: int = -1
    place: int = -1

    def started(self, world: Keeps) -> Task:
        """Make the world reserve what the task needs; return the started task."""
        raise NotImplementedError

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the task could start now.

        Parameters
        ----------
        serves
            Returns whether there is work for a pod at a station.
        """
        raise NotImplementedError

    def ended(self, world: Keeps) -> None:
        """Release what the world reserved for the task; by default do nothing."""

    @property
    def stores(self) -> bool:
        """Whether the task ends with storing its pod at `place`."""
        return self.place >= 0 and self.pod >= 0

    @property
    def lacks_place(self) -> bool:
        """Whether the storage location to which the pod goes is still to be chosen."""
        return self.place < 0 and self.station < 0


@dataclass(slots=True, eq=False)
class StationTask(Task):
    """The task of bringing an available pod, or the pod already carried, to a station."""

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the pod is available or already carried, and the station has work for it."""
        return _can_have(world, self) and serves(self.pod, self.station)

    def ended(self, world: Keeps) -> None:
        """Remove the task from the tasks of its station."""
        del world.stations[self.station].tasks[self.pod]


@dataclass(slots=True, eq=False)
class PickTask(StationTask):
    """The task of bringing a pod to a pick station.

    Attributes
    ----------
    picks
        Units still to be picked.
    """

    kind = "pick"
    picks: deque[Pick] = field(default_factory=deque)

    def started(self, world: Keeps) -> Task:
        """Claim the pod, and bind open requests of the station's orders to it.

        As many requests are bound as the pod's available stock can serve.
        """
        return world.start_pick(world.robots[self.robot], self.pod, self.station)

    def ended(self, world: Keeps) -> None:
        """Remove the task from its station's tasks; stop counting the pod's stock as inbound."""
        StationTask.ended(self, world)
        world.inventory.end_inbound(self.pod)

    @property
    def can_pick(self) -> bool:
        """Whether a unit still to be picked is for an order that has a slot at the station."""
        return any(pick.line.order.station >= 0 for pick in self.picks)


@dataclass(slots=True, eq=False)
class ReplenishTask(StationTask):
    """The task of bringing a pod to a replenishment station.

    Attributes
    ----------
    bundles
        Bundles still to be stored.
    """

    kind = "replenish"
    bundles: deque[Bundle] = field(default_factory=deque)

    def started(self, world: Keeps) -> Task:
        """Claim the pod and take all bundles that wait for it at the station."""
        return world.start_replenish(world.robots[self.robot], self.pod, self.station)


@dataclass(slots=True, eq=False)
class VisitTask(StationTask):
    """The task of bringing a pod to a station other than a pick or replenishment station.

    A kind of station may derive its own class from this one. The controller of the stations decides
    whether a visit is needed. The task is possible if the pod is available or already carried.
    """

    kind = "visit"

    def started(self, world: Keeps) -> Task:
        """Claim the pod."""
        return world.start_visit(self)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the pod is available or already carried."""
        return _can_have(world, self)


@dataclass(slots=True, eq=False)
class ParkTask(Task):
    """The task of storing the pod that a robot carries."""

    kind = "park"

    def started(self, world: Keeps) -> Task:
        """Reserve the place."""
        return world.start_park(world.robots[self.robot], self.place)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the robot carries a pod, and the place is chosen and empty."""
        carries = world.robots[self.robot].pod >= 0
        return carries and self.place >= 0 and world.storage.is_free(self.place)


@dataclass(slots=True, eq=False)
class RepositionTask(Task):
    """The task of fetching a stored pod and storing it at another place."""

    kind = "reposition"

    def started(self, world: Keeps) -> Task:
        """Claim the pod and reserve the place."""
        return world.start_reposition(world.robots[self.robot], self.pod, self.place)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the robot carries nothing, the pod is available and the place empty."""
        empty = world.robots[self.robot].pod < 0
        return empty and _can_have(world, self) and world.storage.is_free(self.place)


@dataclass(slots=True, eq=False)
class RestTask(Task):
    """The task of waiting at a waypoint, usually a storage location."""

    kind = "rest"
    rests = True

    def started(self, world: Keeps) -> Task:
        """Reserve the place."""
        return world.start_rest(world.robots[self.robot], self.place)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the robot carries nothing, and no other robot has reserved the place."""
        empty = world.robots[self.robot].pod < 0
        return empty and world.storage.kept_by[self.place] in (-1, self.robot)


TASKS: tuple[type[Task], ...] = (PickTask, ReplenishTask, ParkTask, RepositionTask, RestTask)
"""Kinds of task in every warehouse; kinds of station add theirs (`rmfs.stations`)."""


def _can_have(world: Keeps, task: Task) -> bool:
    """Whether a robot carries the pod of a task, or is empty and could fetch it."""
    carried = world.robots[task.robot].pod
    return carried == task.pod or (carried < 0 and bool(world.storage.is_at_hand[task.pod]))
