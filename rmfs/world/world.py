"""The world: the operations that change the state, each of which keeps all counts consistent."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

from rmfs.world.orders import Order
from rmfs.world.state import WorldState
from rmfs.world.tasks import ParkTask, Pick, PickTask, ReplenishTask, RepositionTask, RestTask

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rmfs.world.charging import ChargeTask
    from rmfs.world.orders import Bundle, OrderLine
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation
    from rmfs.world.tasks import Task, VisitTask


class World(WorldState):
    """A warehouse and the operations that change it.

    Operations raise ValueError where they would break a rule (a pod claimed twice, a unit bound
    twice, a station overfilled); decisions have to respect these.
    """

    # --- stock and work that appear ---------------------------------------------------------

    def stock(self, pods: list[int], skus: list[int], units: list[int]) -> None:
        """Put the stock of time zero on the pods, one entry per bundle."""
        for pod, sku, count in zip(pods, skus, units, strict=True):
            self.inventory.stock(pod, sku, count)
        self.units_initial += sum(units)

    def add_order(self, order: Order) -> None:
        """Let an order join the backlog."""
        for line in order.lines:
            self.inventory.demand(line.sku, line.units)
        self.orders.add(order)
        self.orders_created += 1

    def cut_order(self, order: Order, keep: Mapping[int, int]) -> None:
        """Let units of an order of the backlog go; without any left, the order is given up.

        Parameters
        ----------
        keep
            Units left of each SKU.

        Raises
        ------
        ValueError
            If it is not in the backlog, is in a pool, or has been split.
        """
        if order not in self.orders or order.queued_at >= 0 or order.parts:
            raise ValueError(f"order {order.index} cannot lose units")
        for line in order.lines:
            self.inventory.undemand(line.sku, line.units - keep.get(line.sku, 0))
        if any(keep.values()):
            order.cut(keep)
            self.orders.lines_changed(order)
        else:
            self.orders.remove(order)
            order.cut(keep)
            order.cancelled_s = self.now_s

    def add_bundle(self, bundle: Bundle) -> None:
        """Let a bundle join the backlog."""
        self.bundles.add(bundle)
        self.bundles_created += 1
        self.unstored_space += bundle.space
        self._incoming[bundle.sku] += bundle.units

    # --- orders ---------------------------------------------------------------------------------

    def queue_order(self, order: Order, station: int) -> None:
        """Let an order of the backlog join the pool of a pick station.

        It needs no slot and keeps its place in the backlog, but pods can be bound to it.
        """
        if order.queued_at >= 0:
            raise ValueError(f"order {order.index} is queued at station {order.queued_at} already")
        if order not in self.orders:
            raise ValueError(f"order {order.index} is not in the backlog")
        target = self.pick_stations[station]
        target.queued[order.index] = order
        target.queued_requests.add(order)
        order.queued_at = station
        order.queued_s = self.now_s
        self.orders.queue_changed(order)

    def unqueue_all(self) -> None:
        """Empty all pools."""
        for station in self.pick_stations:
            for order in list(station.queued.values()):
                self.unqueue_order(order)

    def unqueue_order(self, order: Order) -> None:
        """Take an order out of its pool; requests bound to pods are open again."""
        station = self.pick_stations[order.queued_at]
        for task in station.tasks.values():
            self._give_back(task, [pick for pick in task.picks if pick.line.order is order])
        self._leave_pool(order)
        self.orders.queue_changed(order)

    def assign_order(self, order: Order, station: int) -> Order:
        """Put an order of the backlog on a pick station and open its extract requests.

        Requests of a queued order to which pods were bound meanwhile stay bound. What is left of a
        split order joins its part at the station, if there is one.

        Returns
        -------
        Order
            What has the slot: the order, or its part.

        Raises
        ------
        ValueError
            If the order is queued at another station, or needs a slot and the station is inactive
            or has none free.
        """
        target = self.pick_stations[station]
        joins = order.index in target.orders
        if not joins and (not target.active or target.free_slots <= 0):
            raise ValueError(f"station {station} takes no order now")
        if order.queued_at >= 0:
            if order.queued_at != station:
                raise ValueError(f"order {order.index} is queued at station {order.queued_at}")
            self._leave_pool(order)
        if joins:
            return self.assign_lines(order, station, [line.sku for line in order.lines])
        self.orders.remove(order)
        order.station = station
        if isnan(order.assigned_s):
            order.assigned_s = self.now_s
        order.slots_taken += 1
        target.orders[order.index] = order
        target.changed()
        self._open(target, order.lines)
        return order

    def assign_lines(self, order: Order, station: int, skus: Collection[int]) -> Order:
        """Put some lines of an order of the backlog on a pick station: the order is split.

        They join the part of the order that is there, or become a part of their own, which takes
        a slot. If they are all that is left and there is no such part, the order takes the slot.

        Returns
        -------
        Order
            What now is at the station: the part, or the order itself.

        Raises
        ------
        ValueError
            If these are no lines of an order of the backlog that is in no pool, or they need a slot
            and the station is inactive or has none free.
        """
        target = self.pick_stations[station]
        lines = tuple(line for line in order.lines if line.sku in skus)
        if not lines or order not in self.orders or order.queued_at >= 0:
            raise ValueError(f"order {order.index} cannot give these lines")
        part = target.orders.get(order.index)
        if part is None:
            if len(lines) == len(order.lines):
                return self.assign_order(order, station)
            if not target.active or target.free_slots <= 0:
                raise ValueError(f"station {station} takes no order now")
            now_s = self.now_s
            part = Order(
                order.index, order.created_s, order.due_s, (), 0, 0, station, now_s, whole=order
            )
            part.priority, part.weight = order.priority, order.weight
            order.parts.append(part)
            order.slots_taken += 1
            self.split_orders[order.index] = order
            target.orders[order.index] = part
            target.changed()
        if isnan(order.assigned_s):
            order.assigned_s = self.now_s
        part.take_over(lines)
        if order.lines:
            self.orders.lines_changed(order)
        else:
            self.orders.remove(order)
            order.station = station
        self._open(target, lines)
        return part

    def _open(self, station: PickStation, lines: tuple[OrderLine, ...]) -> None:
        """Open the extract requests of lines that have just come to a station with their order."""
        station.requests.add_lines(lines)
        for line in lines:
            self._lines[station.index, line.sku] += 1
            self.inventory.commit(line.sku, line.open_units)

    def _leave_pool(self, order: Order) -> None:
        station = self.pick_stations[order.queued_at]
        del station.queued[order.index]
        station.queued_requests.remove(order)
        order.queued_at = -1

    def complete_order(self, order: Order) -> Order | None:
        """Take an order, or a part of one, whose units are all picked off its station.

        Returns
        -------
        Order or None
            The order that is complete now as the customer wants it; None if other lines of it are
            still open.
        """
        if order.unpicked_units:
            raise ValueError(f"order {order.index} lacks {order.unpicked_units} units")
        station = self.pick_stations[order.station]
        del station.orders[order.index]
        station.changed()
        for line in order.lines:
            self._lines[order.station, line.sku] -= 1
        order.completed_s = self.now_s
        whole = order if order.whole is None else order.whole
        whole.slots_taken -= 1
        if whole.slots_taken or whole in self.orders:
            return None
        whole.completed_s = self.now_s
        self.orders_completed += 1
        self.split_orders.pop(whole.index, None)
        return whole

    # --- bundles --------------------------------------------------------------------------------

    def promise(self, bundle: Bundle, pod: int) -> None:
        """Keep room on a pod for a bundle (the choice of RPS, not yet released)."""
        if bundle.pod >= 0:
            raise ValueError(f"bundle {bundle.index} has pod {bundle.pod} already")
        self.inventory.promise(pod, bundle.space)
        bundle.pod = pod
        self.bundles.promised(bundle, self.now_s)

    def release_bundles(self, pod: int) -> list[Bundle]:
        """Release what is held back for a pod; returns the bundles that now are assigned."""
        bundles = self.bundles.release(pod)
        for bundle in bundles:
            bundle.released = True
        assigned = [bundle for bundle in bundles if bundle.station >= 0]
        for bundle in assigned:
            self._assign_bundle(bundle)
        return assigned

    def choose_station(self, bundle: Bundle, station: int) -> bool:
        """Reserve a station's space (the choice of ROA); returns whether the bundle is assigned."""
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
        """Make the task to bring a pod to a pick station; binds all requests it can serve."""
        task = PickTask(robot.index, pod, station)
        self._begin_pod_task(robot, task)
        self.pick_stations[station].tasks[pod] = task
        self.inventory.begin_inbound(pod, station)
        requests = self.pick_stations[station].requests
        for sku in [sku for sku in requests.lines if self.inventory.available[sku, pod]]:
            self.extend_pick(task, sku, late_bound=False)
        return task

    def extend_pick(self, task: PickTask, sku: int, late_bound: bool = True) -> int:
        """Bind open requests for a SKU to the pod of a task; returns how many."""
        at_most = self.inventory.available.item(sku, task.pod)
        lines = self.pick_stations[task.station].requests.take(sku, at_most)
        if lines:
            self.inventory.bind(task.pod, sku, len(lines))
            task.picks.extend([Pick(line, late_bound) for line in lines])
        return len(lines)

    def extend_queued(
        self, task: PickTask, order: Order, *, whole: bool, late_bound: bool = True
    ) -> int:
        """Bind open requests of a queued order to the pod of a task; returns how many.

        None if the pod is at the station already: it could only be sent away with them.

        Parameters
        ----------
        whole
            Only if the pod serves all open requests of the order.
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
        return bound

    def give_back(self, task: PickTask) -> int:
        """Open the requests of a task again whose orders are still queued; returns how many."""
        picks = [pick for pick in task.picks if pick.line.order.station < 0]
        self._give_back(task, picks)
        return len(picks)

    def _give_back(self, task: PickTask, picks: list[Pick]) -> None:
        pool = self.pick_stations[task.station].queued_requests
        for pick in reversed(picks):
            line = pick.line
            task.picks.remove(pick)
            pool.reopen(line)
            self.inventory.unbind(task.pod, line.sku, 1)
            self.inventory.commit(line.sku, -1)
            self.orders.changed(line)

    def start_replenish(self, robot: Robot, pod: int, station: int) -> ReplenishTask:
        """Make the task to bring a pod to a replenishment station for all its bundles there."""
        task = ReplenishTask(robot.index, pod, station)
        self._begin_pod_task(robot, task)
        target = self._replenishment_station(station)
        target.tasks[pod] = task
        task.bundles.extend(target.take(pod))
        return task

    def extend_replenish(self, task: ReplenishTask) -> int:
        """Add the bundles that wait at the station for the pod of a task; returns how many."""
        bundles = self._replenishment_station(task.station).take(task.pod)
        task.bundles.extend(bundles)
        return len(bundles)

    def start_visit(self, task: VisitTask) -> VisitTask:
        """Begin the task to bring a pod to a station of another kind."""
        robot = self.robots[task.robot]
        self._begin_pod_task(robot, task)
        self.stations[task.station].tasks[task.pod] = task
        return task

    def start_charge(self, task: ChargeTask) -> ChargeTask:
        """Begin the task to go for energy."""
        self.stations[task.station].tasks[task.robot] = task
        self._set_task(self.robots[task.robot], task)
        return task

    def start_park(self, robot: Robot, place: int) -> Task:
        """Make the task to store the pod a robot carries at an empty place."""
        task = ParkTask(robot.index, robot.pod, place=place)
        if self.storage.pod_at[place] >= 0:
            raise ValueError(f"place {place} holds pod {self.storage.pod_at[place]}")
        self.storage.keep(robot, place)
        self._set_task(robot, task)
        return task

    def start_reposition(self, robot: Robot, pod: int, place: int) -> Task:
        """Make the task to fetch a pod and store it at an empty place."""
        if robot.pod >= 0:
            raise ValueError(f"robot {robot.index} carries pod {robot.pod} already")
        if self.storage.pod_at[place] >= 0:
            raise ValueError(f"place {place} holds pod {self.storage.pod_at[place]}")
        task = RepositionTask(robot.index, pod, place=place)
        self.storage.keep(robot, place)
        self._begin_pod_task(robot, task)
        return task

    def start_rest(self, robot: Robot, place: int) -> Task:
        """Make the task to rest at a place, beneath a stored pod or not."""
        task = RestTask(robot.index, place=place)
        self.storage.keep(robot, place)
        self._set_task(robot, task)
        return task

    def end_task(self, robot: Robot) -> None:
        """End the task of a robot; a pod it carries stays claimed by it."""
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
        """Let a robot start to lift a pod."""
        self.storage.lift(pod)
        robot.pod = pod

    def set_down(self, robot: Robot, place: int) -> None:
        """Let a robot end setting down its pod, which then is anyone's."""
        pod = robot.pod
        robot.pod = -1
        self.storage.set_down(pod, place)

    def pick_unit(self, task: PickTask, chosen: Pick | None = None) -> Pick:
        """Let the next unit of a task leave its pod whose order is on the station.

        Parameters
        ----------
        chosen
            Another one of these, to be picked first.
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
        """Let the next bundle of a task go into its pod."""
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
