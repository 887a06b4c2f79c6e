"""Random operations on a world, compared with a model of dictionaries and loops."""

from __future__ import annotations

from collections import Counter

import numpy as np
from doubles import Situation, small_layout, small_skus
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from rmfs.world import verify
from rmfs.world.tasks import ParkTask, PickTask, ReplenishTask, RepositionTask, Task

SKUS, PODS, ROBOTS = 4, 5, 3
small = st.integers(1, 3)


class NaiveWarehouse:
    """Dictionaries and loops: units on pods, units bound, space promised, units ordered."""

    def __init__(self) -> None:
        self.on_pod: Counter[tuple[int, int]] = Counter()
        self.bound: Counter[tuple[int, int]] = Counter()
        self.promised: Counter[int] = Counter()
        self.wanted_in_backlog: Counter[int] = Counter()
        self.open_at: Counter[tuple[int, int]] = Counter()

    def available(self, sku: int, pod: int) -> int:
        return self.on_pod[sku, pod] - self.bound[sku, pod]

    def uncommitted(self, sku: int) -> int:
        stock = sum(self.available(sku, pod) for pod in range(PODS))
        at_stations = sum(self.open_at[station, sku] for station in range(2))
        return stock - at_stations - self.wanted_in_backlog[sku]


class WorldMachine(RuleBasedStateMachine):
    """Every operation of the world, in any order that the rules of the warehouse allow."""

    @initialize(seed=st.integers(0, 2**16))
    def begin(self, seed: int) -> None:
        layout = small_layout(
            places=8,
            pods=PODS,
            robots=ROBOTS,
            pick_stations=2,
            replenishment_stations=2,
            slots=3,
            pod_capacity=40.0,
            station_capacity=30.0,
        )
        self.situation = Situation(layout, small_skus(SKUS, space=1.5))
        self.world = self.situation.world
        self.naive = NaiveWarehouse()
        self.rng = np.random.default_rng(seed)
        for pod in range(PODS):
            for sku in range(SKUS):
                units = int(self.rng.integers(0, 5))
                self.world.stock([pod], [sku], [units])
                self.naive.on_pod[sku, pod] += units

    def any_of(self, things):
        things = list(things)
        return things[int(self.rng.integers(len(things)))] if things else None

    def robots(self, kind: type[Task], carrying: bool):
        return [
            robot
            for robot in self.world.robots
            if type(robot.task) is kind and (robot.pod >= 0) == carrying
        ]

    # --- orders ---------------------------------------------------------------------------------

    @rule(units=st.dictionaries(st.integers(0, SKUS - 1), small, min_size=1, max_size=3))
    def order(self, units) -> None:
        self.situation.order(**{f"s{sku}": count for sku, count in units.items()})
        for sku, count in units.items():
            self.naive.wanted_in_backlog[sku] += count

    @precondition(lambda self: len(self.world.orders))
    @rule()
    def assign_order(self) -> None:
        free = [station for station in self.world.pick_stations if station.free_slots]
        order = self.any_of(self.world.orders)
        stock = self.world.inventory.free_stock
        if not free or any(stock[line.sku] < line.units for line in order.lines):
            return
        station = self.any_of(free).index
        if order.queued_at >= 0:
            if not self.world.pick_stations[order.queued_at].free_slots:
                return
            station = order.queued_at
        lines = order.lines
        self.world.assign_order(order, station)
        self.opened(station, lines)

    def opened(self, station, lines) -> None:
        for line in lines:
            self.naive.wanted_in_backlog[line.sku] -= line.open_units
            self.naive.open_at[station, line.sku] += line.open_units

    @rule()
    def assign_lines(self) -> None:
        """One line of an order, or more, of which its part at the station may have others."""
        order = self.any_of(order for order in self.world.orders if order.queued_at < 0)
        station = self.any_of(self.world.pick_stations)
        if order is None or not (station.free_slots or order.index in station.orders):
            return
        lines = tuple(line for line in order.lines if self.any_of([True, False]))
        stock = self.world.inventory.free_stock
        if not lines or any(stock[line.sku] < line.units for line in lines):
            return
        units = sum(line.units for line in order.all_lines)
        part = self.world.assign_lines(order, station.index, [line.sku for line in lines])
        assert set(lines) <= set(part.lines)
        assert part is station.orders[order.index]
        assert units == sum(line.units for line in order.all_lines)
        self.opened(station.index, lines)

    @rule(station=st.integers(0, 1))
    def queue_order(self, station) -> None:
        order = self.any_of(order for order in self.world.orders if order.queued_at < 0)
        if order is not None:
            self.world.queue_order(order, station)

    @rule()
    def unqueue_order(self) -> None:
        order = self.any_of(order for order in self.world.orders if order.queued_at >= 0)
        if order is None:
            return
        for task in self.world.pick_stations[order.queued_at].tasks.values():
            for pick in task.picks:
                if pick.line.order is order:
                    self.naive_give_back(pick.line.sku, task.pod)
        self.world.unqueue_order(order)

    def naive_give_back(self, sku, pod) -> None:
        self.naive.bound[sku, pod] -= 1
        self.naive.wanted_in_backlog[sku] += 1

    # --- bundles --------------------------------------------------------------------------------

    @rule(sku=st.integers(0, SKUS - 1), units=small)
    def bundle(self, sku, units) -> None:
        self.situation.bundle(sku, units)

    @rule()
    def promise(self) -> None:
        bundle = self.any_of(self.world.bundles.without_pod.values())
        if bundle is None:
            return
        used = [sum(1.5 * self.naive.on_pod[s, p] for s in range(SKUS)) for p in range(PODS)]
        fits = [
            pod for pod in range(PODS) if used[pod] + self.naive.promised[pod] + bundle.space <= 40
        ]
        pod = self.any_of(fits)
        if pod is not None:
            self.world.promise(bundle, pod)
            self.naive.promised[pod] += bundle.space

    @rule()
    def release(self) -> None:
        pod = self.any_of(self.world.bundles.unreleased)
        if pod is not None:
            self.world.release_bundles(pod)

    @rule()
    def choose_station(self) -> None:
        bundle = self.any_of(self.world.bundles.without_station.values())
        stations = [
            station.index
            for station in self.world.replenishment_stations
            if bundle is not None and bundle.space <= station.free_space
        ]
        if stations:
            self.world.choose_station(bundle, self.any_of(stations))

    # --- robots ---------------------------------------------------------------------------------

    @rule(station=st.integers(0, 3))
    def bring(self, station) -> None:
        robot = self.any_of(robot for robot in self.world.robots if robot.task is None)
        if robot is None:
            return
        pods = np.flatnonzero(self.world.storage.is_at_hand).tolist()
        pod = robot.pod if robot.pod >= 0 else self.any_of(pods)
        if pod is None:
            return
        if station < 2:
            for sku in range(SKUS):
                self.naive_bind(sku, pod, station)
            self.world.start_pick(robot, pod, station)
        else:
            self.world.start_replenish(robot, pod, station)
        if robot.pod < 0:
            place = self.world.storage.place_of[pod]
            if self.world.storage.kept_by[place] in (-1, robot.index):
                self.world.storage.keep(robot, place)
                robot.waypoint = place

    def naive_bind(self, sku, pod, station) -> None:
        count = min(self.naive.available(sku, pod), self.naive.open_at[station, sku])
        self.naive.bound[sku, pod] += count
        self.naive.open_at[station, sku] -= count

    @rule(sku=st.integers(0, SKUS - 1))
    def extend(self, sku) -> None:
        robot = self.any_of(self.robots(PickTask, carrying=True))
        if robot is not None:
            self.naive_bind(sku, robot.pod, robot.task.station)
            self.world.extend_pick(robot.task, sku)
        robot = self.any_of(self.robots(ReplenishTask, carrying=True))
        if robot is not None:
            self.world.extend_replenish(robot.task)

    @rule(whole=st.booleans())
    def extend_queued(self, whole) -> None:
        """Every unit that the pod has available, of every open request of the order."""
        robot = self.any_of(self.robots(PickTask, carrying=True))
        if robot is None:
            return
        order = self.any_of(self.world.pick_stations[robot.task.station].queued.values())
        if order is None:
            return
        counts = {
            line.sku: min(line.open_units, self.naive.available(line.sku, robot.pod))
            for line in order.lines
        }
        if whole and any(counts[line.sku] < line.open_units for line in order.lines):
            counts = {}
        bound = self.world.extend_queued(robot.task, order, whole=whole)
        assert bound == sum(counts.values())
        for sku, count in counts.items():
            self.naive.bound[sku, robot.pod] += count
            self.naive.wanted_in_backlog[sku] -= count

    @rule()
    def give_back(self) -> None:
        robot = self.any_of(self.robots(PickTask, carrying=True))
        if robot is not None:
            for pick in robot.task.picks:
                if pick.line.order.station < 0:
                    self.naive_give_back(pick.line.sku, robot.pod)
            self.world.give_back(robot.task)
            assert all(pick.line.order.station >= 0 for pick in robot.task.picks)

    @rule()
    def lift(self) -> None:
        storage = self.world.storage
        robots = self.robots(PickTask, False) + self.robots(ReplenishTask, False)
        ready = [r for r in robots if storage.place_of[r.task.pod] in r.places]
        robot = self.any_of(ready)
        if robot is not None:
            self.world.lift(robot, robot.task.pod)
            robot.waypoint = self.world.stations[robot.task.station].waypoint
            storage.departed(robot, robot.waypoint)

    @rule()
    def pick(self) -> None:
        robot = self.any_of(r for r in self.robots(PickTask, True) if r.task.can_pick)
        if robot is not None:
            line = self.world.pick_unit(robot.task).line
            self.naive.on_pod[line.sku, robot.pod] -= 1
            self.naive.bound[line.sku, robot.pod] -= 1
            if not line.order.unpicked_units:
                self.world.complete_order(line.order)

    @rule()
    def store(self) -> None:
        robot = self.any_of(r for r in self.robots(ReplenishTask, True) if r.task.bundles)
        if robot is not None:
            bundle = self.world.store_bundle(robot.task)
            self.naive.on_pod[bundle.sku, robot.pod] += bundle.units
            self.naive.promised[robot.pod] -= bundle.space

    @rule()
    def end_task(self) -> None:
        done = [r for r in self.robots(PickTask, True) if not r.task.picks]
        done += [r for r in self.robots(ReplenishTask, True) if not r.task.bundles]
        robot = self.any_of(done)
        if robot is not None:
            self.world.end_task(robot)

    @rule()
    def park(self) -> None:
        robot = self.any_of(r for r in self.world.robots if r.task is None and r.pod >= 0)
        places = self.world.storage.places[self.world.storage.is_empty].tolist()
        if robot is not None and places:
            place = self.any_of(places)
            self.world.start_park(robot, place)
            robot.waypoint = place
            self.world.storage.departed(robot, place)

    @rule()
    def set_down(self) -> None:
        robot = self.any_of(self.robots(ParkTask, True))
        if robot is not None:
            self.world.set_down(robot, robot.waypoint)
            self.world.end_task(robot)

    @rule()
    def reposition(self) -> None:
        robot = self.any_of(r for r in self.world.robots if r.task is None and r.pod < 0)
        storage = self.world.storage
        pods = [
            pod
            for pod in np.flatnonzero(storage.is_at_hand).tolist()
            if robot is not None and storage.kept_by[storage.place_of[pod]] in (-1, robot.index)
        ]
        places = storage.places[storage.is_empty].tolist()
        if pods and places:
            pod = self.any_of(pods)
            self.world.start_reposition(robot, pod, self.any_of(places))
            storage.keep(robot, storage.place_of[pod])
            robot.waypoint = storage.place_of[pod]
            storage.departed(robot, robot.waypoint)

    @rule()
    def move_pod(self) -> None:
        """Lift the pod, drive to the place, which was kept all the time, and set it down."""
        robot = self.any_of(self.robots(RepositionTask, carrying=False))
        if robot is not None:
            task = robot.task
            assert self.world.storage.kept_by[task.place] == robot.index
            self.world.lift(robot, task.pod)
            robot.waypoint = task.place
            self.world.storage.departed(robot, task.place)
            self.world.set_down(robot, task.place)
            self.world.end_task(robot)

    @rule()
    def rest(self) -> None:
        robot = self.any_of(robot for robot in self.world.robots if robot.is_free)
        places = self.world.storage.places[self.world.storage.is_restful].tolist()
        if robot is not None and places:
            place = self.any_of(places)
            self.world.start_rest(robot, place)
            robot.waypoint = place
            self.world.storage.departed(robot, place)

    # --- comparison -----------------------------------------------------------------------------

    @invariant()
    def same_counts(self) -> None:
        if not hasattr(self, "world"):
            return
        inventory = self.world.inventory
        for sku in range(SKUS):
            bound = sum(self.naive.bound[sku, pod] for pod in range(PODS))
            open_units = sum(self.naive.open_at[station, sku] for station in range(2))
            ordered = bound + open_units + self.naive.wanted_in_backlog[sku]
            assert inventory.wanted[sku] == ordered
            assert inventory.uncommitted[sku] == self.naive.uncommitted(sku)
            for pod in range(PODS):
                assert inventory.contained[sku, pod] == self.naive.on_pod[sku, pod]
                assert inventory.available[sku, pod] == self.naive.available(sku, pod)
            for station in range(2):
                assert self.world.need[station, sku] == self.naive.open_at[station, sku]
        for pod in range(PODS):
            assert inventory.promised[pod] == self.naive.promised[pod]
        verify(self.world)


TestWorld = WorldMachine.TestCase
TestWorld.settings = settings(max_examples=60, stateful_step_count=40, deadline=None)
