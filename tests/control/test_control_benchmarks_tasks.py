"""Time of one decision of the rules for pods, places and tasks: under 1 ms at the median.

2,000 pods with 12 of 1,000 SKUs each, 12 + 6 stations with 10 orders or bundles each, 200 orders in
the backlog, 150 robots of which 120 bring pods. As in a run, stock and demand change a little from
decision to decision.
"""

from __future__ import annotations

from itertools import count
from typing import Any

import numpy as np
import pytest
from doubles import Situation, small_layout, small_skus

from rmfs.control import registry
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.problems import Problem, Trigger
from rmfs.control.psa.nearest import Nearest

pytestmark = pytest.mark.benchmark

PODS, SKUS, ORDERS, STATIONS, OTHERS = 2000, 1000, 200, 12, 6
LIMIT_S = 1e-3

PICK_SCORERS: list[Any] = [
    "random",
    "nearest",
    {"criterion": "nearest", "metric": "euclidean"},
    {"criterion": "nearest", "metric": "manhattan"},
    {"criterion": "nearest", "metric": "path"},
    "pile-on",
    "age",
    "lateness",
    "completeable",
    "demand",
    "fill",
]
PLACES: list[dict[str, Any]] = [
    {"name": "nearest"},
    {"name": "nearest", "metric": "euclidean"},
    {"name": "nearest", "metric": "manhattan"},
    {"name": "nearest", "metric": "path"},
    {"name": "random"},
    {"name": "fixed"},
    {"name": "station-based"},
    {"name": "turnover"},
    {"name": "cache"},
    {"name": "utility"},
]


class Busy(Situation):
    """The warehouse of the benchmark; `something_happens` picks a unit or lets an order come."""

    def __init__(self) -> None:
        layout = small_layout(
            places=PODS + 300,
            pods=PODS,
            robots=150,
            pick_stations=STATIONS,
            replenishment_stations=OTHERS,
            slots=12,
            pod_capacity=500.0,
        )
        super().__init__(layout, small_skus(SKUS))
        self.random = np.random.default_rng(0)
        self.fill()
        for number in range(STATIONS * 10):
            self.assigned(number % STATIONS, **self.lines())
        for robot in range(STATIONS * 10):
            self.world.start_pick(self.world.robots[robot], pod=robot, station=robot % STATIONS)
        for number in range(STATIONS * 10):
            self.waiting_bundle(200 + number, STATIONS + number % OTHERS, units=1)
        for number in range(STATIONS):
            self.assigned(number, **self.lines())
        for _ in range(ORDERS):
            self.order(**self.lines())
        self.numbers = count()

    def fill(self) -> None:
        pods = np.repeat(np.arange(PODS), 12)
        skus = [self.random.choice(SKUS, 12, replace=False) for _ in range(PODS)]
        self.world.stock(pods.tolist(), np.concatenate(skus).tolist(), [8] * len(pods))

    def lines(self) -> dict[str, int]:
        skus = self.random.choice(SKUS, 1 + int(self.random.integers(3)), replace=False)
        return {f"s{sku}": 1 for sku in skus}

    def something_happens(self) -> None:
        """A bundle is stored on a pod, and one order leaves the backlog as another joins it."""
        self.world.now_s += 1.0
        pod, sku = int(self.random.integers(PODS)), int(self.random.integers(SKUS))
        bundle = self.bundle(sku, units=1)
        self.world.promise(bundle, pod)
        self.world.inventory.store(pod, sku, 1)
        for tracker in self.view.trackers:
            if Trigger.BUNDLE_STORED in tracker.hears:
                tracker.hear(Trigger.BUNDLE_STORED, bundle)
        order = next(iter(self.world.orders))
        self.world.orders.remove(order)
        for line in order.lines:
            self.world.inventory.demand(line.sku, -line.units)
        self.order(**self.lines())


@pytest.fixture(scope="module")
def busy() -> Busy:
    return Busy()


def rule(busy: Busy, problem: Problem, name: str, **parameters: Any) -> Any:
    return busy.make(registry.find(problem, name), **parameters)


def measure(benchmark, busy: Busy, decide) -> Any:
    """Measure a decision, each after something has happened; the median must be under 1 ms."""
    result = benchmark.pedantic(decide, setup=busy.something_happens, rounds=120, warmup_rounds=5)
    assert benchmark.stats.stats.median < LIMIT_S
    return result


def title(given: Any) -> str:
    return given if isinstance(given, str) else " ".join(str(value) for value in given.values())


@pytest.mark.parametrize("criterion", PICK_SCORERS, ids=title)
def test_pps_criterion_alone(benchmark, busy, criterion) -> None:
    controller = rule(busy, Problem.PPS, "lexicographic", pick_pod=(criterion, "random"))
    robot, station = busy.world.robots[149], busy.world.pick_stations[0]
    assert measure(benchmark, busy, lambda: controller.pick_pod(robot, station)) >= 0


@pytest.mark.parametrize("name", ["lexicographic", "random"])
def test_pps(benchmark, busy, name) -> None:
    controller = rule(busy, Problem.PPS, name)
    robot, station = busy.world.robots[149], busy.world.pick_stations[0]
    assert measure(benchmark, busy, lambda: controller.pick_pod(robot, station)) >= 0


@pytest.mark.parametrize("criterion", ["random", "nearest", "work-amount", "demand"])
def test_pps_replenishment(benchmark, busy, criterion) -> None:
    controller = rule(busy, Problem.PPS, "lexicographic", replenishment_pod=(criterion, "random"))
    robot, station = busy.world.robots[149], busy.world.replenishment_stations[0]
    assert measure(benchmark, busy, lambda: controller.replenishment_pod(robot, station)) >= 0


def test_pps_next_station(benchmark, busy) -> None:
    controller = rule(busy, Problem.PPS, "lexicographic")
    robot, stations = busy.world.robots[149], list(range(STATIONS))
    robot.pod = 1999
    try:
        found = measure(benchmark, busy, lambda: controller.next_station(robot, stations))
    finally:
        robot.pod = -1
    assert found >= 0


@pytest.mark.parametrize("queued", ["assigned-and-completable", "assigned-and-queued"])
def test_pps_with_a_pool_of_20_orders(benchmark, queued) -> None:
    busy = Busy()
    orders = [order for order in busy.world.orders if len(order.lines) > 1][:20]
    for order in orders:
        busy.world.queue_order(order, 0)
        busy.world.orders.orders[order.index] = busy.world.orders.orders.pop(order.index)
    controller = rule(busy, Problem.PPS, "lexicographic", consider=queued, reserve=queued)
    robot, station = busy.world.robots[149], busy.world.pick_stations[0]
    decide = lambda: controller.pick_pod(robot, station)  # noqa: E731
    result = benchmark.pedantic(decide, rounds=120, warmup_rounds=5)
    assert benchmark.stats.stats.median < LIMIT_S
    assert result >= 0


@pytest.mark.parametrize("table", PLACES, ids=title)
def test_psa(benchmark, busy, table) -> None:
    parameters = {key: value for key, value in table.items() if key != "name"}
    controller = rule(busy, Problem.PSA, table["name"], **parameters)
    robot = busy.world.robots[149]
    robot.waypoint = busy.world.stations[0].waypoint
    robot.pod = 1999
    try:
        place = measure(benchmark, busy, lambda: controller.place(robot))
    finally:
        robot.pod = -1
    # no way leads anywhere in this layout
    assert place >= 0 or table.get("metric") == "path"


@pytest.mark.parametrize("name", ["cache", "cache-drop-off", "utility"])
def test_repositioning(benchmark, busy, name) -> None:
    given = {"drop_off_places": 8} if name == "cache-drop-off" else {}
    controller = rule(busy, Problem.REPOSITIONING, name, **given)
    robot = busy.world.robots[149]
    assert measure(benchmark, busy, lambda: controller.find(robot)) is not None


class Others:
    """PPS lexicographic and PSA nearest, as TA would consult them."""

    def __init__(self, busy: Busy) -> None:
        self._pps, self._psa = busy.make(Lexicographic), busy.make(Nearest)
        self._view = busy.view
        self.serves = self._pps.serves
        self.next_station = self._pps.next_station
        self.place_for = self._psa.place

    def pod_for(self, robot, station):
        if station < STATIONS:
            return self._pps.pick_pod(robot, self._view.pick_stations[station])
        others = self._view.replenishment_stations
        return self._pps.replenishment_pod(robot, others[station - STATIONS])

    def may_move(self):
        return True

    def move_for(self, robot):
        return None


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("balanced", {"robots_per_station": 10**6}),
        ("balanced", {"robots_per_station": 10**6, "search_all": True}),
        ("constant-ratio", {}),
        ("random", {"switch_probability": 0.0}),
        ("brute-force", {}),
        ("swarm", {}),
    ],
    ids=["balanced", "balanced search-all", "constant-ratio", "random", "brute-force", "swarm"],
)
def test_ta_with_what_it_asks(benchmark, busy, name, parameters) -> None:
    """One task for an empty robot, the choice of the pod included."""
    controller = rule(busy, Problem.TA, name, **parameters)
    others = Others(busy)
    task = measure(benchmark, busy, lambda: next(iter(controller.decide(others))))
    assert task.robot is not None


@pytest.mark.parametrize("name", ["all", "backlog-threshold", "constant-ratio", "work-shifts"])
def test_sa(benchmark, busy, name) -> None:
    controller = rule(busy, Problem.SA, name)
    list(controller.decide())
    measure(benchmark, busy, lambda: list(controller.decide()))
