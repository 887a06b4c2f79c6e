"""State of the stations: assigned work, robots under way, and the robot being served."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

from rmfs.world.requests import OpenRequests
from rmfs.world.tasks import PickTask, ReplenishTask

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.layout.model import PickStation as PickStationLayout
    from rmfs.layout.model import ReplenishmentStation as ReplenishmentStationLayout
    from rmfs.world.news import News
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.robots import Robot
    from rmfs.world.tasks import Task


T = TypeVar("T", bound="Task")


class Station(Generic[T]):
    """State that stations of all kinds have; each kind adds further state.

    Attributes
    ----------
    index
        Number in the common numbering: pick stations, then replenishment stations, then others.
    number
        Number among the stations of its kind.
    waypoint, tier
        Waypoint and tier at which robots are served.
    visits
        Number of times that a robot has reached the head of the queue so far.
    tasks
        By pod, the unfinished tasks of bringing a pod to this station, oldest first.
    """

    def __init__(self, index: int, number: int, waypoint: int, tier: int) -> None:
        self.index = index
        self.number = number
        self.waypoint = waypoint
        self.tier = tier
        self._active = False
        self._robot = -1
        self.visits = 0
        self.tasks: dict[int, T] = {}

    @property
    def active(self) -> bool:
        """Whether new work may be assigned; an inactive station still finishes the work it has."""
        return self._active

    @active.setter
    def active(self, active: bool) -> None:
        self._active = active
        self.changed()

    @property
    def robot(self) -> int:
        """The robot at the head of the queue, or -1."""
        return self._robot

    @robot.setter
    def robot(self, robot: int) -> None:
        self._robot = robot
        self.changed()

    def changed(self) -> None:
        """React to a change of the station's state or contents; by default do nothing."""

    def verify(self, robots: Sequence[Robot]) -> None:
        """Check that the state is consistent; a kind of station may add checks.

        Raises
        ------
        AssertionError
            If the state is inconsistent; the message names the error.
        """
        for pod, task in self.tasks.items():
            told = (task.pod, task.station, robots[task.robot].task)
            if told != (pod, self.index, task):
                raise AssertionError(f"inconsistent world: tasks of station {self.index}")

    @property
    def has_work(self) -> bool:
        """Whether the station has unfinished work; by default, whether it has tasks."""
        return bool(self.tasks)

    @property
    def has_open_work(self) -> bool:
        """Whether the station has work for which no pod is under way; by default False."""
        return False

    @property
    def work_version(self) -> tuple[int, ...]:
        """Version of the station's work, which changes when work is added; by default constant."""
        return ()


class PickStation(Station[PickTask]):
    """A station where units go from pods into orders.

    Attributes
    ----------
    slots
        Maximum number of open orders.
    orders
        The open orders by index, in the order of assignment.
    requests
        Open requests (not yet bound to a pod) of the orders in `orders`.
    queued
        The pool: orders of the backlog reserved for this station, in the order in which they
        joined.
    queued_requests
        Open requests of the orders in the pool.
    """

    def __init__(
        self,
        index: int,
        layout: PickStationLayout,
        tier: int,
        need: NDArray[np.int32],
        queued_need: NDArray[np.int32],
        slot_news: News,
        work_news: News,
    ) -> None:
        super().__init__(index, index, layout.waypoint, tier)
        self._slot_news = slot_news
        self.slots = layout.order_slots
        self.orders: dict[int, Order] = {}
        self.requests = OpenRequests(need, work_news, index)
        self.queued: dict[int, Order] = {}
        self.queued_requests = OpenRequests(queued_need, work_news, index)

    def changed(self) -> None:
        """Tell the followers of `WorldState.slot_news` that this station has changed."""
        self._slot_news.tell(self.index)

    @property
    def free_slots(self) -> int:
        """Number of slots without an order."""
        return self.slots - len(self.orders)

    @property
    def has_work(self) -> bool:
        """Whether the station has open orders."""
        return bool(self.orders)

    @property
    def has_open_work(self) -> bool:
        """Whether the station's open orders or its pool have open requests."""
        return self.requests.units > 0 or self.queued_requests.units > 0

    @property
    def work_version(self) -> tuple[int, ...]:
        """Version that changes when other pods than before may be useful.

        This is so when requests are added, when an order in the pool can get a slot, and when only
        some of the open requests of an order in the pool are bound to a pod.
        """
        if not self.queued:
            return (self.requests.version,)
        return self.requests.version, self.queued_requests.version, self.free_slots > 0


class ReplenishmentStation(Station[ReplenishTask]):
    """A station where bundles go into pods.

    Attributes
    ----------
    capacity
        Maximum of `used`, in space units.
    used
        Space of the bundles for which ROA has reserved space here and whose transfer has not
        started, in space units.
    bundles
        Number of the bundles counted in `used`.
    waiting
        By pod, the assigned bundles not yet part of a task. The pod whose first bundle has waited
        longest comes first.
    version
        Increases whenever a bundle is added to `waiting`.
    """

    def __init__(
        self,
        index: int,
        number: int,
        layout: ReplenishmentStationLayout,
        tier: int,
        waiting_count: NDArray[np.int32],
        work_news: News,
    ) -> None:
        super().__init__(index, number, layout.waypoint, tier)
        self.capacity = layout.capacity
        self.used = 0.0
        self.bundles = 0
        self.waiting: dict[int, list[Bundle]] = {}
        self.version = 0
        self._waiting_count = waiting_count
        self._work_news = work_news

    @property
    def free_space(self) -> float:
        """Space available for further bundles, in space units."""
        return self.capacity - self.used

    @property
    def has_work(self) -> bool:
        """Whether `used` counts any bundles, that is, bundles whose transfer has not started."""
        return self.used > 0

    @property
    def has_open_work(self) -> bool:
        """Whether there are bundles for which no pod is under way."""
        return bool(self.waiting)

    @property
    def work_version(self) -> tuple[int, ...]:
        """Version that changes when a bundle is added to `waiting`."""
        return (self.version,)

    def add(self, bundle: Bundle) -> None:
        """Add a bundle that waits for its pod."""
        self.waiting.setdefault(bundle.pod, []).append(bundle)
        self._waiting_count[bundle.pod] += 1
        self.version += 1
        self._work_news.tell(self.index)

    def take(self, pod: int) -> list[Bundle]:
        """Remove the bundles for a pod from `waiting`, and return them."""
        self._waiting_count[pod] = 0
        self._work_news.tell(self.index)
        return self.waiting.pop(pod, [])
