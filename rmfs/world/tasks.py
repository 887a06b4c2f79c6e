"""What a robot has been told to do: a class for each kind of task.

Every task is a way: with a pod or without one, to a station or to a place. A kind adds when it is
possible, what the world keeps for it when it starts, and what is given back when it ends.
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
    """Says whether there is work for a pod at a station."""

    def __call__(self, pod: int, station: int) -> bool:
        """Whether there is work."""
        ...


class Keeps(Protocol):
    """What tasks need of the world, which keeps pods, places and work for them."""

    robots: list[Robot]
    storage: Storage
    inventory: Inventory
    stations: list[Any]

    def start_pick(self, robot: Robot, pod: int, station: int) -> PickTask:
        """Begin to bring a pod to a pick station."""
        ...

    def start_replenish(self, robot: Robot, pod: int, station: int) -> ReplenishTask:
        """Begin to bring a pod to a replenishment station."""
        ...

    def start_visit(self, task: VisitTask) -> VisitTask:
        """Begin to bring a pod to a station of another kind."""
        ...

    def start_charge(self, task: Any) -> Task:
        """Begin to go for energy."""
        ...

    def start_park(self, robot: Robot, place: int) -> Task:
        """Begin to store a pod."""
        ...

    def start_reposition(self, robot: Robot, pod: int, place: int) -> Task:
        """Begin to move a stored pod."""
        ...

    def start_rest(self, robot: Robot, place: int) -> Task:
        """Begin to rest."""
        ...


class Pick(NamedTuple):
    """One unit to be picked: the line it is for, and whether it was bound on the pod's way."""

    line: OrderLine
    late_bound: bool


@dataclass(slots=True, eq=False)
class Task:
    """One task of one robot.

    Attributes
    ----------
    kind
        The word for it in tables, traces and the viewer.
    rests
        Whether a robot with this task may be given another one at any time.
    pod
        The pod to bring or to store; -1 for none.
    station
        Where the pod is to be served, or -1.
    place
        Where the pod is to be stored, or the robot is to rest; a waypoint, or -1.
    """

    kind: ClassVar[str]
    rests: ClassVar[bool] = False

    robot: int
    pod: int = -1
    station: int = -1
    place: int = -1

    def started(self, world: Keeps) -> Task:
        """Let the world keep what the task needs; returns the task as it has begun."""
        raise NotImplementedError

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether it could start now.

        Parameters
        ----------
        serves
            Tells whether there is work for a pod at a station.
        """
        raise NotImplementedError

    def ended(self, world: Keeps) -> None:
        """Give back what the world kept."""

    @property
    def stores(self) -> bool:
        """Whether it ends when its pod stands at its place."""
        return self.place >= 0 and self.pod >= 0

    @property
    def lacks_place(self) -> bool:
        """Whether somebody has yet to say where the pod is to be stored."""
        return self.place < 0 and self.station < 0


@dataclass(slots=True, eq=False)
class StationTask(Task):
    """Bring a pod to a station, or go on with the one carried."""

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the pod can be had, and there is work for it."""
        return _can_have(world, self) and serves(self.pod, self.station)

    def ended(self, world: Keeps) -> None:
        """Nothing is under way to the station any more."""
        del world.stations[self.station].tasks[self.pod]


@dataclass(slots=True, eq=False)
class PickTask(StationTask):
    """Bring a pod to a pick station.

    Attributes
    ----------
    picks
        Units still to be picked.
    """

    kind = "pick"
    picks: deque[Pick] = field(default_factory=deque)

    def started(self, world: Keeps) -> Task:
        """Bind all requests it can serve."""
        return world.start_pick(world.robots[self.robot], self.pod, self.station)

    def ended(self, world: Keeps) -> None:
        """Its stock is no longer on the way."""
        StationTask.ended(self, world)
        world.inventory.end_inbound(self.pod)

    @property
    def can_pick(self) -> bool:
        """Whether the order of one of its picks is on the station (others are still queued)."""
        return any(pick.line.order.station >= 0 for pick in self.picks)


@dataclass(slots=True, eq=False)
class ReplenishTask(StationTask):
    """Bring a pod to a replenishment station.

    Attributes
    ----------
    bundles
        Bundles still to be stored.
    """

    kind = "replenish"
    bundles: deque[Bundle] = field(default_factory=deque)

    def started(self, world: Keeps) -> Task:
        """Take all bundles that wait for the pod."""
        return world.start_replenish(world.robots[self.robot], self.pod, self.station)


@dataclass(slots=True, eq=False)
class VisitTask(StationTask):
    """Bring a pod to a station of any other kind; a kind of station derives its own from it.

    Who asks for a visit knows why: it is possible if the pod can be had.
    """

    kind = "visit"

    def started(self, world: Keeps) -> Task:
        """Claim the pod."""
        return world.start_visit(self)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the pod can be had."""
        return _can_have(world, self)


@dataclass(slots=True, eq=False)
class ParkTask(Task):
    """Store the pod a robot carries."""

    kind = "park"

    def started(self, world: Keeps) -> Task:
        """Keep the place."""
        return world.start_park(world.robots[self.robot], self.place)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether there is a pod, and a place for it."""
        carries = world.robots[self.robot].pod >= 0
        return carries and self.place >= 0 and world.storage.is_free(self.place)


@dataclass(slots=True, eq=False)
class RepositionTask(Task):
    """Fetch a stored pod and store it at another place."""

    kind = "reposition"

    def started(self, world: Keeps) -> Task:
        """Claim the pod and keep the place."""
        return world.start_reposition(world.robots[self.robot], self.pod, self.place)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the robot is empty, the pod at hand, and the place free."""
        empty = world.robots[self.robot].pod < 0
        return empty and _can_have(world, self) and world.storage.is_free(self.place)


@dataclass(slots=True, eq=False)
class RestTask(Task):
    """Wait at a place."""

    kind = "rest"
    rests = True

    def started(self, world: Keeps) -> Task:
        """Keep the place."""
        return world.start_rest(world.robots[self.robot], self.place)

    def is_possible(self, world: Keeps, serves: Serves) -> bool:
        """Whether the robot is empty, and nobody else keeps the place."""
        empty = world.robots[self.robot].pod < 0
        return empty and world.storage.kept_by[self.place] in (-1, self.robot)


TASKS: tuple[type[Task], ...] = (PickTask, ReplenishTask, ParkTask, RepositionTask, RestTask)
"""Kinds of task that every warehouse has; kinds of station add theirs (`rmfs.stations`)."""


def _can_have(world: Keeps, task: Task) -> bool:
    """Whether a robot carries the pod of a task, or is empty and could fetch it."""
    carried = world.robots[task.robot].pod
    return carried == task.pod or (carried < 0 and bool(world.storage.is_at_hand[task.pod]))
