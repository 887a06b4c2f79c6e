"""A small warehouse by hand, and traffic without hindrance, for tests with exact expectations."""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.control.settings import settings
from rmfs.control.travel import Travel
from rmfs.control.view import View
from rmfs.layout.model import Layout, PickStation, ReplenishmentStation, RobotKind, Tier
from rmfs.random import Stream, generator
from rmfs.scenario import Scenario, SkuSet
from rmfs.traffic import EventKind, Step
from rmfs.world import Bundle, Order, World

if TYPE_CHECKING:
    from collections.abc import Sequence

KIND = RobotKind(
    radius_m=0.35,
    acceleration_m_s2=1.0,
    deceleration_m_s2=1.0,
    top_speed_m_s=1.0,
    full_turn_s=4.0,
    pod_transfer_s=2.0,
)


def small_layout(
    *,
    places: int = 6,
    pods: int = 4,
    robots: int = 2,
    pick_stations: int = 1,
    replenishment_stations: int = 1,
    slots: int = 4,
    station_capacity: float = 1000.0,
    pod_capacity: float = 100.0,
    unit_transfer_s: float = 10.0,
    unit_pick_s: float = 3.0,
    bundle_transfer_s: float = 10.0,
) -> Layout:
    """Places on y = 0 from x = 0 on, pods on the first, robots on y = 2, stations on y = 10.

    Waypoints: places first, then the robots' starts, then the pick stations (x = 0, 10, ...), then
    the replenishment stations (x = 5, 15, ...). There are no edges: for `FreeTraffic` only.
    """
    x = [float(i) for i in range(places)] + [float(i) for i in range(robots)]
    y = [0.0] * places + [2.0] * robots
    x += [10.0 * i for i in range(pick_stations)]
    x += [5.0 + 10.0 * i for i in range(replenishment_stations)]
    y += [10.0] * (pick_stations + replenishment_stations)
    first_station = places + robots
    first_replenishment = first_station + pick_stations
    count = len(x)
    return Layout(
        name="small",
        tiers=(Tier(length_m=20.0, width_m=12.0),),
        x_m=np.array(x),
        y_m=np.array(y),
        tier=np.zeros(count, np.int16),
        edge_start=np.zeros(count + 1, np.int32),
        edge_target=np.zeros(0, np.int32),
        is_storage=np.arange(count) < places,
        is_queue=np.arange(count) >= first_station,
        pick_stations=tuple(
            PickStation(w, (w,), 0.45, slots, unit_transfer_s, unit_pick_s, 1)
            for w in range(first_station, first_replenishment)
        ),
        replenishment_stations=tuple(
            ReplenishmentStation(w, (w,), 0.45, station_capacity, bundle_transfer_s, 1)
            for w in range(first_replenishment, count)
        ),
        elevators=(),
        pod_waypoint=np.arange(pods, dtype=np.int32),
        pod_capacity=np.full(pods, pod_capacity),
        pod_radius_m=0.45,
        robot_waypoint=np.arange(places, places + robots, dtype=np.int32),
        robot_heading_rad=np.zeros(robots),
        robot_kind=np.zeros(robots, np.int16),
        robot_kinds=(KIND,),
    )


def small_skus(count: int = 5, space: float = 1.0, bundle_units: int = 4) -> SkuSet:
    """SKUs that all take the same space and are equally popular."""
    return SkuSet(
        ids=np.arange(count),
        popularity=np.ones(count),
        space_per_unit=np.full(count, space),
        bundle_units=np.full(count, bundle_units),
    )


class FreeTraffic:
    """Robots that never hinder each other; the face of `rmfs.traffic.Traffic`.

    A way takes its Manhattan distance at 1 m/s, lifting and setting down 2 s each. A station serves
    robots in order of their arrival; the next one is at the head `move_up_s` after the one before
    was commanded away.
    """

    def __init__(self, layout: Layout, move_up_s: float = 0.0) -> None:
        self.now_us = 0
        self._layout = layout
        self._move_up_us = round(move_up_s * 1e6)
        self._stations = [station.waypoint for station in layout.stations]
        self._at = layout.robot_waypoint.tolist()
        self._goal = layout.robot_waypoint.tolist()
        self._program: list[list[tuple[int, int]]] = [[] for _ in self._at]
        self._carries = [False] * len(self._at)
        self._turn = [0] * len(self._at)
        self._busy = [False] * len(self._at)
        self._queues: list[list[int]] = [[] for _ in self._stations]
        self._queue_of = [-1] * len(self._at)
        self._heap: list[tuple[int, int, int, int, int]] = []
        self._serial = 0
        self._outbox: list[tuple[int, int, int, int]] = []
        self.commands: list[tuple[int, int, list[tuple[int, int]]]] = []

    # --- the face ---------------------------------------------------------------------------

    def command(self, robot: int, steps: Sequence[tuple[int, int]]) -> None:
        if self._busy[robot]:
            raise ValueError(f"robot {robot} is lifting or setting down a pod")
        self.commands.append((self.now_us, robot, list(steps)))
        self._turn[robot] += 1
        self._leave_queue(robot)
        self._program[robot] = list(steps)
        self._begin(robot)

    def advance(self, until_us: int, ignored: int = 0) -> list[tuple[int, int, int, int]]:
        while not self._outbox and self._heap and self._heap[0][0] <= until_us:
            self.now_us, _, robot, turn, kind = heapq.heappop(self._heap)
            if turn == self._turn[robot]:
                self._happen(robot, kind)
            self._outbox = [one for one in self._outbox if not ignored >> one[1] & 1]
        if not self._outbox:
            self.now_us = max(self.now_us, until_us)
        events, self._outbox = self._outbox, []
        return events

    def rest_waypoint(self, robot: int) -> int:
        return self._goal[robot]

    def robot_waypoint(self, robot: int) -> int:
        return self._at[robot]

    def travel_times_to(self, waypoint: int, loaded: bool, robot: int = 0) -> np.ndarray:
        x, y = self._layout.x_m, self._layout.y_m
        return np.abs(x - x[waypoint]) + np.abs(y - y[waypoint])

    travel_times_from = travel_times_to

    def blocked(self) -> list[int]:
        return []

    def reset_statistics(self) -> None:
        pass

    def motion(self) -> dict[str, np.ndarray]:
        return {}

    def state_report(self) -> str:
        return ""

    # --- what happens -----------------------------------------------------------------------

    def _begin(self, robot: int) -> None:
        if not self._program[robot]:
            self._emit(EventKind.IDLE, robot, self._at[robot])
            return
        step, value = self._program[robot][0]
        if step in (Step.DRIVE, Step.STATION):
            goal = value if step == Step.DRIVE else self._stations[value]
            if goal != self._at[robot] and self._layout.is_storage[self._at[robot]]:
                self._emit(EventKind.DEPARTED, robot, self._at[robot])
            self._goal[robot] = goal
            distance = self.travel_times_to(goal, loaded=False)[self._at[robot]]
            self._later(round(distance * 1e6), robot, step)
            return
        self._busy[robot] = True
        started = EventKind.LIFT_STARTED if step == Step.LIFT else EventKind.SET_DOWN_STARTED
        self._emit(started, robot, value)
        self._later(2_000_000, robot, step)

    def _happen(self, robot: int, kind: int) -> None:
        step, value = self._program[robot][0]
        self._busy[robot] = False
        self._at[robot] = self._goal[robot]
        if kind == Step.STATION:
            self._queues[value].append(robot)
            self._queue_of[robot] = value
            if self._queues[value][0] == robot:
                self._at_head(robot, value)
            return
        if kind < 0:
            self._at_head(robot, value)
            return
        self._program[robot].pop(0)
        done = {
            Step.DRIVE: EventKind.ARRIVED,
            Step.LIFT: EventKind.LIFTED,
            Step.SET_DOWN: EventKind.SET_DOWN,
        }
        self._carries[robot] = step == Step.LIFT or (self._carries[robot] and step == Step.DRIVE)
        self._emit(done[step], robot, value)
        self._begin(robot)

    def _at_head(self, robot: int, station: int) -> None:
        self._program[robot].clear()
        self._emit(EventKind.AT_HEAD, robot, station)

    def _leave_queue(self, robot: int) -> None:
        station = self._queue_of[robot]
        if station < 0:
            return
        was_head = self._queues[station][0] == robot
        self._queues[station].remove(robot)
        self._queue_of[robot] = -1
        if was_head and self._queues[station]:
            self._later(self._move_up_us, self._queues[station][0], -1)

    def _later(self, delay_us: int, robot: int, kind: int) -> None:
        self._serial += 1
        entry = (self.now_us + delay_us, self._serial, robot, self._turn[robot], int(kind))
        heapq.heappush(self._heap, entry)

    def _emit(self, kind: EventKind, robot: int, value: int) -> None:
        self._outbox.append((self.now_us, int(kind), robot, value))


class Situation:
    """A world by hand, and what a controller needs to look at it."""

    def __init__(self, layout: Layout | None = None, skus: SkuSet | None = None) -> None:
        self.layout = layout if layout is not None else small_layout()
        self.world = World(self.layout, skus if skus is not None else small_skus())
        for station in self.world.stations:
            station.active = True
        self.traffic = FreeTraffic(self.layout)
        self.view = View(self.world, Travel(self.layout, self.traffic))
        self.rng = generator(0, Stream.CONTROLLERS)

    def make(self, controller: type, **parameters: Any) -> Any:
        """Make a controller that looks at this world."""
        model = controller.parameters_model(**parameters)
        return controller(model, self.view, self.rng)

    def stock(self, pod: int, **units: int) -> None:
        """Put units on a pod: `stock(0, s1=3)` for three units of SKU 1."""
        for sku, count in units.items():
            self.world.stock([pod], [int(sku[1:])], [count])

    def order(self, due_s: float = 0.0, **units: int) -> Order:
        """Let an order join the backlog."""
        skus = tuple(int(sku[1:]) for sku in units)
        now_s = self.world.now_s
        order = Order.of(self.world.orders_created, now_s, due_s, skus, tuple(units.values()))
        self.world.add_order(order)
        return order

    def assigned(self, station: int = 0, due_s: float = 0.0, **units: int) -> Order:
        """Put a new order on a station."""
        order = self.order(due_s, **units)
        self.world.assign_order(order, station)
        return order

    def bundle(self, sku: int = 0, units: int = 4) -> Bundle:
        """Let a bundle join the backlog."""
        space = float(units * self.world.skus.space_per_unit[sku])
        bundle = Bundle(self.world.bundles_created, sku, units, space, self.world.now_s)
        self.world.add_bundle(bundle)
        return bundle

    def waiting_bundle(self, pod: int, station: int, sku: int = 0, units: int = 4) -> Bundle:
        """Let a bundle wait at a station for its pod."""
        bundle = self.bundle(sku, units)
        self.world.promise(bundle, pod)
        self.world.release_bundles(pod)
        self.world.choose_station(bundle, station)
        return bundle

    def carry(self, robot: int, pod: int, station: int = 0) -> None:
        """Let a robot carry a pod to a pick station and stand at the head there."""
        state = self.world.robots[robot]
        self.world.start_pick(state, pod, station)
        self.world.lift(state, pod)
        state.waypoint = self.world.stations[station].waypoint
        state.station = station
        self.world.stations[station].robot = robot
        self.world.stations[station].visits += 1


def rules(**problems: Any) -> Any:
    """Make controller settings from tables, for example `rules(psa={"name": "random"})`."""
    return settings({"format": "rmfs-controllers/1", "name": "test", **problems})


def quiet_scenario(**changes: Any) -> Scenario:
    """Make a scenario in which nothing is stocked or ordered unless said otherwise."""
    table: dict[str, Any] = {
        "format": "rmfs-scenario/1",
        "name": "test",
        "duration_s": 600.0,
        "warmup_s": 0.0,
        "skus": {"count": 5, "space_per_unit": {"distribution": "uniform", "min": 1, "max": 1}},
        "stock": {"initial_share": 0.0},
        "demand": {"mode": "backlog", "orders": 0},
        "replenishment": {"mode": "backlog", "bundles": 0},
    }
    return Scenario.model_validate(table | changes)
