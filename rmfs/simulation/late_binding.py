"""Late binding: adds new work to a task while its pod is being carried to a station."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.problems import Problem
from rmfs.observer import Observer
from rmfs.world.tasks import PickTask, ReplenishTask

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rmfs.control.travel import Travel
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.events import Events
    from rmfs.world import World
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.stations import PickStation
    from rmfs.world.tasks import Task


class LateBinding(Observer):
    """Adds new work to tasks while their pods are being carried to a station.

    Work is added when an order is assigned or queued (put into the pool of a station), when a
    bundle is assigned, and when a pod is lifted. A task gets new work only while a robot carries
    the pod of the task, and while the task still has units to pick or bundles to store. A robot
    whose task has no work left gets a new task from TA. If several pods can serve an order, the one
    that will reach the station first gets the work first.

    In addition, when a picking task starts, requests of queued orders are bound to the pod of the
    task. The parameters of the PPS controller determine whether work is added at all, and whether
    requests of queued orders are bound.
    """

    def __init__(
        self, world: World, travel: Travel, controllers: ControllerSet, events: Events
    ) -> None:
        self._world = world
        self._travel = travel
        self._controllers = controllers
        self._events = events
        self._orders: list[Order] = []
        self._queued: list[Order] = []
        self._bundles: list[Bundle] = []
        self._pods: list[int] = []

    def order_assigned(self, order: Order) -> None:
        """Record an order assigned to a pick station."""
        self._orders.append(order)

    def order_queued(self, order: Order) -> None:
        """Record an order put into the pool of a pick station."""
        self._queued.append(order)

    def bundle_assigned(self, bundle: Bundle) -> None:
        """Record a bundle assigned to a station and a pod."""
        self._bundles.append(bundle)

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        """Record that a robot starts to lift a pod, if the pod is to be brought to a station."""
        task = self._world.robots[robot].task
        if task is not None and task.station >= 0:
            self._pods.append(pod)

    def task_started(self, time_s: float, robot: int, kind: str, station: int) -> None:
        """Bind requests of queued orders to the pod of a picking task that has just started.

        These requests become the last ones of the task.
        """
        task = self._world.robots[robot].task
        if isinstance(task, PickTask):
            queued = self._world.pick_stations[station].queued
            if queued:
                self._bind_queued(task, queued.values(), late_bound=False)

    def bind(self) -> None:
        """Add to tasks the work that has become available since the last call of this method."""
        given = self._controllers[Problem.PPS].parameters
        if given.late_bundles:
            for bundle in self._bundles:
                self._extend_replenish(bundle.station, bundle.pod)
        if given.late_picks:
            for order in self._orders:
                self._bind_order(order)
            for order in self._queued:
                self._offer_queued(order)
        for pod in self._pods:
            self._extend(pod, given.late_picks, given.late_bundles)
        self._bundles.clear()
        self._orders.clear()
        self._queued.clear()
        self._pods.clear()

    def _bind_order(self, order: Order) -> None:
        station = self._world.pick_stations[order.station]
        available = self._world.inventory.available.item
        carried = [task for task in station.tasks.values() if task.picks and self._is_carried(task)]
        if not carried:
            return
        for line in order.lines:
            if not line.open_units:
                continue
            tasks = [task for task in carried if available(line.sku, task.pod)]
            if len(tasks) > 1:
                self._sort_by_arrival(tasks, station)
            for task in tasks:
                self._tell(task, self._world.extend_pick(task, line.sku))

    def _extend(self, pod: int, picks: bool, bundles: bool) -> None:
        """Find work for a pod that has just been lifted."""
        task = self._world.robots[self._world.storage.claimed_by[pod]].task
        if task is None or task.pod != pod:
            return
        if isinstance(task, ReplenishTask):
            if bundles:
                self._extend_replenish(task.station, pod)
        elif picks and isinstance(task, PickTask) and task.picks:
            requests = self._world.pick_stations[task.station].requests
            available = self._world.inventory.available.item
            skus = [sku for sku in requests.lines if available(sku, pod)]
            self._tell(task, sum([self._world.extend_pick(task, sku) for sku in skus]))
            queued = self._world.pick_stations[task.station].queued
            if queued:
                self._bind_queued(task, queued.values())

    def _offer_queued(self, order: Order) -> None:
        """Bind a queued order to pods on their way to its station."""
        if order.queued_at < 0:
            return
        station = self._world.pick_stations[order.queued_at]
        tasks = [task for task in station.tasks.values() if task.picks and self._is_carried(task)]
        self._sort_by_arrival(tasks, station)
        for task in tasks:
            self._bind_queued(task, [order])

    def _bind_queued(
        self, task: PickTask, orders: Iterable[Order], late_bound: bool = True
    ) -> None:
        mode = self._controllers[Problem.PPS].parameters.reserve
        if mode == "assigned":
            return
        whole = mode == "assigned-and-completable"
        bound, partly = 0, False
        for order in orders:
            units = self._world.extend_queued(task, order, whole=whole, late_bound=late_bound)
            bound += units
            partly |= units > 0 and order.open_units > 0
        self._tell(task, bound)
        if partly:
            self._events.pool_changed(task.station)

    def _tell(self, task: PickTask, bound: int) -> None:
        """Notify of requests bound to the pod of a task, if there are any."""
        if bound:
            self._events.picks_changed(self._world.now_s, task.robot)

    def _extend_replenish(self, station: int, pod: int) -> None:
        task = self._world.stations[station].tasks.get(pod)
        if isinstance(task, ReplenishTask) and task.bundles and self._is_carried(task):
            self._world.extend_replenish(task)

    def _is_carried(self, task: Task) -> bool:
        return self._world.robots[task.robot].pod == task.pod

    def _sort_by_arrival(self, tasks: list[PickTask], station: PickStation) -> None:
        """Sort tasks by the remaining travel time of their robots, then by age."""
        times = self._travel.to(station.waypoint, loaded=True)
        tasks.sort(key=lambda task: times.item(self._travel.robot_waypoint(task.robot)))
