"""The world: a warehouse, and operations that change it while all counts stay consistent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.world.order_operations import OrderOperations
from rmfs.world.orders import Order
from rmfs.world.tasks import ParkTask, Pick, PickTask, ReplenishTask, RepositionTask, RestTask

if TYPE_CHECKING:
    from rmfs.world.charging import ChargeTask
    from rmfs.world.orders import Bundle
    from rmfs.world.robots import Robot
    from rmfs.world.tasks import Task, VisitTask


class World(OrderOperations):
    """A warehouse and the operations that change it.

    An operation raises ValueError if it is not allowed, for example if it would let two robots
    claim a pod, bind a unit twice or overfill a station. Decisions must avoid such operations.
    """

    # --- stock and work that appear ---------------------------------------------------------

    def stock(self, pods: list[int], skus: list[int], units: list[int]) -> None:
        """Put the initial stock on the pods: entry i puts `units[i]` of `skus[i]` on `pods[i]`."""
        for pod, sku, count in zip(pods, skus, units, strict=True):
            self.inventory.stock(pod, sku, count)
        self.units_initial += sum(units)

    def add_bundle(self, bundle: Bundle) -> None:
        """Add a bundle that has arrived to the backlog of bundles."""
        self.bundles.add(bundle)
        self.bundles_created += 1
        self.unstored_space += bundle.space
        self._incoming[bundle.sku] += bundle.units

    # --- bundles --------------------------------------------------------------------------------

    def promise(self, bundle: Bundle, pod: int) -> None:
        """Reserve room for a bundle on the pod that RPS has chosen.

        The bundle is assigned once RPS has also released it and ROA has chosen its station.
        """
        if bundle.pod >= 0:
            raise ValueError(f"bundle {bundle.index} has pod {bundle.pod} already")
        self.inventory.promise(pod, bundle.space)
        bundle.pod = pod
        self.bundles.promised(bundle, self.now_s)

    def release_bundles(self, pod: int) -> list[Bundle]:
        """Release the bundles promised to a pod; return those that are now assigned.

        These are the bundles for which ROA has already chosen a station.
        """
        bundles = self.bundles.release(pod)
        for bundle in bundles:
            bundle.released = True
        assigned = [bundle for bundle in bundles if bundle.station >= 0]
        for bundle in assigned:
            self._assign_bundle(bundle)
        return assigned

    def choose_station(self, bundle: Bundle, station: int) -> bool:
        """Reserve space for a bundle at the replenishment station that ROA has chosen.

        Returns
        -------
        bool
            Whether the bundle is now assigned, that is, whether RPS has already released it.
        """
        target = self._replenishment_station(station)
        if bundle.station >= 0:
            raise ValueError(f"bundle {bundle.index} has station {bundle.station} already")
        if not target.active or bundle.space > target.free_space:
            raise ValueError(f"station {station} takes no bundle of {bundle.space:g} space units")
        target.used += bundle.space
        target.bundles += 1
        bundle.station = station
        self.bundles.station_chosen(bundle)
        if bundle.released:
            self._assign_bundle(bundle)
        return bundle.released

    def _assign_bundle(self, bundle: Bundle) -> None:
        self.bundles.remove(bundle)
        bundle.assigned_s = self.now_s
        self._replenishment_station(bundle.station).add(bundle)

    # --- tasks ----------------------------------------------------------------------------------

    def start_pick(self, robot: Robot, pod: int, station: int) -> PickTask:
        """Start the task of bringing a pod to a pick station.

        The open requests of the station's open orders are bound to the pod as far as its available
        stock suffices.
        """
        task = PickTask(robot.index, pod, station)
        self._begin_pod_task(robot, task)
        self.pick_stations[station].tasks[pod] = task
        self.inventory.begin_inbound(pod, station)
        requests = self.pick_stations[station].requests
        available = self.inventory.available.item
        for sku in [sku for sku in requests.lines if available(sku, pod)]:
            self.extend_pick(task, sku, late_bound=False)
        return task

    def extend_pick(self, task: PickTask, sku: int, late_bound: bool = True) -> int:
        """Bind open requests for a SKU to the pod of a task; return how many were bound."""
        at_most = self.inventory.available.item(sku, task.pod)
        lines = self.pick_stations[task.station].requests.take(sku, at_most)
        if lines:
            self.inventory.bind(task.pod, sku, len(lines))
            task.picks.extend([Pick(line, late_bound) for line in lines])
        return len(lines)

    def extend_queued(
        self, task: PickTask, order: Order, *, whole: bool, late_bound: bool = True
    ) -> int:
        """Bind open requests of an order to the pod of a task; return how many were bound.

        The order must be in the pool of the task's station. Nothing is bound if the pod is already
        at the head of the station's queue.

        Parameters
        ----------
        whole
            Whether to bind requests only if the pod can serve all open requests of the order.
        """
        if self.robots[task.robot].station == task.station:
            return 0
        available = self.inventory.available.item
        lines = [line for line in order.lines if line.open_units]
        if whole and any(available(line.sku, task.pod) < line.open_units for line in lines):
            return 0
        pool = self.pick_stations[task.station].queued_requests
        bound = 0
        for line in lines:
            count = pool.take_line(line, available(line.sku, task.pod))
            if count:
                self.inventory.bind(task.pod, line.sku, count)
                self.inventory.commit(line.sku, count)
                self.orders.changed(line)
                task.picks.extend([Pick(line, late_bound)] * count)
                bound += count
        if bound and order.open_units:
            pool.version += 1
        return bound

    def give_back(self, task: PickTask) -> int:
        """Reopen those requests of a task that belong to orders without a slot; return how many."""
        picks = [pick for pick in task.picks if pick.line.order.station < 0]
        self._give_back(task, picks)
        return len(picks)

    def start_replenish(self, robot: Robot, pod: int, station: int) -> ReplenishTask:
        """Start the task of bringing a pod to a replenishment station.

        The task takes all bundles that wait there for the pod.
        """
        task = ReplenishTask(robot.index, pod, station)
        self._begin_pod_task(robot, task)
        target = self._replenishment_station(station)
        target.tasks[pod] = task
        task.bundles.extend(target.take(pod))
        return task

    def extend_replenish(self, task: ReplenishTask) -> int:
        """Extend a task by bundles that wait for its pod at its station; return their number."""
        bundles = self._replenishment_station(task.station).take(task.pod)
        task.bundles.extend(bundles)
        return len(bundles)

    def start_visit(self, task: VisitTask) -> VisitTask:
        """Start bringing a pod to a station other than a pick or replenishment station."""
        robot = self.robots[task.robot]
        self._begin_pod_task(robot, task)
        self.stations[task.station].tasks[task.pod] = task
        return task

    def start_charge(self, task: ChargeTask) -> ChargeTask:
        """Start the task of going to a charger or swap station."""
        self.stations[task.station].tasks[task.robot] = task
        self._set_task(self.robots[task.robot], task)
        return task

    def start_park(self, robot: Robot, place: int) -> Task:
        """Start the task of storing a robot's pod at an empty storage location."""
        task = ParkTask(robot.index, robot.pod, place=place)
        if self.storage.pod_at[place] >= 0:
            raise ValueError(f"place {place} holds pod {self.storage.pod_at[place]}")
        self.storage.keep(robot, place)
        self._set_task(robot, task)
        return task

    def start_reposition(self, robot: Robot, pod: int, place: int) -> Task:
        """Start the task of fetching a pod and storing it at an empty storage location."""
        if robot.pod >= 0:
            raise ValueError(f"robot {robot.index} carries pod {robot.pod} already")
        if self.storage.pod_at[place] >= 0:
            raise ValueError(f"place {place} holds pod {self.storage.pod_at[place]}")
        task = RepositionTask(robot.index, pod, place=place)
        self.storage.keep(robot, place)
        self._begin_pod_task(robot, task)
        return task

    def start_rest(self, robot: Robot, place: int) -> Task:
        """Start the task of resting at a waypoint, possibly beneath a stored pod."""
        task = RestTask(robot.index, place=place)
        self.storage.keep(robot, place)
        self._set_task(robot, task)
        return task

    def end_task(self, robot: Robot) -> None:
        """End the task of a robot; a pod that the robot carries stays claimed by it."""
        if robot.task is not None:
            robot.task.ended(self)
        self._set_task(robot, None)

    def _begin_pod_task(self, robot: Robot, task: Task) -> None:
        if robot.pod not in (-1, task.pod):
            raise ValueError(f"robot {robot.index} carries pod {robot.pod}, not {task.pod}")
        self.storage.claim(task.pod, robot.index)
        self._set_task(robot, task)

    def _set_task(self, robot: Robot, task: Task | None) -> None:
        robot.task = task
        self.asking.pop(robot.index, None)
        self.resting.pop(robot.index, None)
        if task is None:
            self.asking[robot.index] = robot
        elif task.rests:
            self.resting[robot.index] = robot
        self.storage.robot_changed(robot)

    # --- what robots and stations do ------------------------------------------------------------

    def lift(self, robot: Robot, pod: int) -> None:
        """Record that a robot starts to lift a pod."""
        self.storage.lift(pod)
        robot.pod = pod

    def set_down(self, robot: Robot, place: int) -> None:
        """Record that a robot has set down its pod, which other robots may claim from now on."""
        pod = robot.pod
        robot.pod = -1
        self.storage.set_down(pod, place)

    def pick_unit(self, task: PickTask, chosen: Pick | None = None) -> Pick:
        """Pick a unit of a task, and return it.

        Parameters
        ----------
        chosen
            The unit to be picked. Default: the next one whose order has a slot at the station.
        """
        picks = task.picks
        pick = picks[0] if chosen is None else chosen
        if chosen is not None:
            picks.remove(chosen)
        elif pick.line.order.station < 0:
            pick = next(pick for pick in picks if pick.line.order.station >= 0)
            picks.remove(pick)
        else:
            picks.popleft()
        line = pick.line
        self.inventory.pick(task.pod, line.sku)
        line.picked_units += 1
        line.order.unpicked_units -= 1
        self.units_picked += 1
        return pick

    def store_bundle(self, task: ReplenishTask) -> Bundle:
        """Store the next bundle of a task in the task's pod; return the bundle."""
        bundle = task.bundles.popleft()
        self.inventory.store(task.pod, bundle.sku, bundle.units)
        station = self._replenishment_station(task.station)
        station.used -= bundle.space
        station.bundles -= 1
        bundle.stored_s = self.now_s
        self.bundles_stored += 1
        self.unstored_space -= bundle.space
        self._incoming[bundle.sku] -= bundle.units
        self.units_stored += bundle.units
        return bundle
