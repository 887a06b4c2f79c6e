"""Time of one decision of each rule at 2,000 pods, 1,000 SKUs and 200 orders: under 1 ms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from doubles import Situation, small_layout, small_skus

from rmfs.control import registry
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.fast_lane import FastLane
from rmfs.control.poa.queue import Queue
from rmfs.control.poa.ties import order_rank
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.pps.random import RandomPod
from rmfs.control.problems import Problem
from rmfs.control.psa.nearest import Nearest
from rmfs.control.psa.random import RandomPlace
from rmfs.control.rps.buffered import BufferParameters
from rmfs.control.rps.correlative import Correlative
from rmfs.control.view import View
from rmfs.scenario import OrderContent

pytestmark = pytest.mark.benchmark

PODS, SKUS, ORDERS, STATIONS = 2000, 1000, 200, 12


def crowded() -> Situation:
    """12 SKUs on each pod; 10 orders and 10 pods under way at each station; 200 orders wait.

    A pod is being served at each pick station. For 40 pods ten bundles are released.
    """
    layout = small_layout(
        places=PODS + 300,
        pods=PODS,
        robots=150,
        pick_stations=STATIONS,
        replenishment_stations=6,
        slots=12,
        pod_capacity=500.0,
    )
    made = Situation(layout, small_skus(SKUS))
    rng = np.random.default_rng(0)
    skus = [(pod, int(sku)) for pod in range(PODS) for sku in rng.choice(SKUS, 12, replace=False)]
    made.world.stock([p for p, _ in skus], [s for _, s in skus], [8] * len(skus))

    def lines() -> dict[str, int]:
        return {f"s{sku}": 1 for sku in rng.choice(SKUS, 1 + int(rng.integers(3)), replace=False)}

    for number in range(STATIONS * 10):
        made.assigned(number % STATIONS, **lines())
    for robot in range(STATIONS):
        made.carry(robot, pod=robot, station=robot)
    for robot in range(STATIONS, STATIONS * 10):
        made.world.start_pick(made.world.robots[robot], pod=robot, station=robot % STATIONS)
    for _ in range(ORDERS):
        made.order(**lines())
    for pod in range(PODS - 40, PODS):
        for _ in range(10):
            made.world.promise(made.bundle(int(rng.integers(SKUS))), pod)
        made.world.release_bundles(pod)
    return made


@pytest.fixture(scope="module")
def situation() -> Situation:
    """One for all rules: decisions are not applied."""
    return crowded()


@pytest.fixture(autouse=True)
def under_a_millisecond(benchmark) -> Iterator[None]:
    """Every decision here, at the median."""
    yield
    if benchmark.stats is not None:
        assert benchmark.stats["median"] < 1e-3


def rules_of(problem: Problem) -> list[str]:
    names = registry.built_in(problem)
    return [name for name in names if not registry.find(problem, name).is_dummy]


@pytest.mark.parametrize("rule", rules_of(Problem.POA))
def test_poa(benchmark, situation, rule) -> None:
    """Without the fast lane, which is measured below."""
    kind = registry.find(Problem.POA, rule)
    has_lane = "fast_lane" in kind.parameters_model.model_fields
    controller = situation.make(kind, **({"fast_lane": False} if has_lane else {}))
    assert benchmark(lambda: next(controller.decide())).order in situation.world.orders


def test_poa_fast_lane(benchmark, situation) -> None:
    """The pods at all twelve stations have just arrived."""

    def first() -> AssignOrder:
        return next(FastLane(situation.view, order_rank("due-time", situation.rng)).decide())

    assert benchmark(first).order in situation.world.orders


@pytest.mark.parametrize("score", ["depletion", "surplus"])
def test_poa_foresight_with_bonus(benchmark, situation, score) -> None:
    controller = situation.make(registry.find(Problem.POA, "foresight"), score=score)
    assert benchmark(lambda: next(controller.decide())).order in situation.world.orders


def test_poa_queue_with_full_pools(benchmark) -> None:
    """Slots are filled from pools of 16 or 17 orders; the pool itself is filled in `test_poa`."""
    situation = crowded()
    for number, order in enumerate(list(situation.world.orders)):
        situation.world.queue_order(order, number % STATIONS)
    controller = situation.make(Queue)
    assert benchmark(lambda: next(controller.decide())).order in situation.world.orders


@pytest.mark.parametrize("rule", rules_of(Problem.ROA))
def test_roa(benchmark, situation, rule) -> None:
    controller = situation.make(registry.find(Problem.ROA, rule))
    assert benchmark(lambda: next(controller.decide())).station >= STATIONS


@pytest.mark.parametrize("rule", rules_of(Problem.RPS))
def test_rps(benchmark, situation, rule) -> None:
    """The bundle has a station, for the rules that wait for it; no rule sticks to its last pod."""
    kind = registry.find(Problem.RPS, rule)
    sticky = "stick_to_pod" in kind.parameters_model.model_fields
    controller = situation.make(kind, **({"stick_to_pod": False} if sticky else {}))
    bundle = situation.bundle(sku=5)
    situation.world.choose_station(bundle, STATIONS)

    def choose() -> int:
        controller._last = [-1] * 3 if rule == "turnover" else -1
        return controller.choose(bundle)

    assert benchmark(choose) >= 0


def test_rps_correlative_after_long(benchmark, situation) -> None:
    """5000 orders of 20 lines have been counted: 2 million pairs."""
    rng = np.random.default_rng(0)
    contents = [
        OrderContent(tuple(s), (), 0.0, 0) for s in rng.integers(0, SKUS, (5000, 20)).tolist()
    ]
    view = View(situation.world, situation.view.travel, draw_past_orders=lambda: contents)
    controller = Correlative(BufferParameters(), view, situation.rng)
    assert benchmark(controller.choose, situation.bundle(sku=5)) >= 0


@pytest.mark.parametrize("rule", [Lexicographic, RandomPod])
def test_pps(benchmark, situation, rule) -> None:
    controller = situation.make(rule)
    robot, station = situation.world.robots[149], situation.world.pick_stations[0]
    assert benchmark(controller.pick_pod, robot, station) >= 0


@pytest.mark.parametrize("rule", [Nearest, RandomPlace])
def test_psa(benchmark, situation, rule) -> None:
    controller = situation.make(rule)
    assert benchmark(controller.place, situation.world.robots[149]) >= 0
