"""Time of one decision of each rule at 2,000 pods, 1,000 SKUs and 200 orders: under 1 ms."""

from __future__ import annotations

import numpy as np
import pytest
from doubles import Situation, small_layout, small_skus

from rmfs.control.poa.pod_match import PodMatch
from rmfs.control.poa.random import RandomOrder
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.pps.random import RandomPod
from rmfs.control.psa.nearest import Nearest
from rmfs.control.psa.random import RandomPlace
from rmfs.control.rps.emptiest import Emptiest

pytestmark = pytest.mark.benchmark

PODS, SKUS, ORDERS, STATIONS = 2000, 1000, 200, 12


@pytest.fixture(scope="module")
def situation() -> Situation:
    """12 SKUs on each pod; 10 orders and 10 pods under way at each station; 200 orders wait."""
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
    for robot in range(STATIONS * 10):
        made.world.start_pick(made.world.robots[robot], pod=robot, station=robot % STATIONS)
    for _ in range(ORDERS):
        made.order(**lines())
    return made


def test_poa_pod_match(benchmark, situation) -> None:
    controller = situation.make(PodMatch)
    assert benchmark(lambda: next(controller.decide())).order in situation.world.orders


def test_poa_random(benchmark, situation) -> None:
    controller = situation.make(RandomOrder)
    assert benchmark(lambda: next(controller.decide())).order in situation.world.orders


@pytest.mark.parametrize("rule", [Lexicographic, RandomPod])
def test_pps(benchmark, situation, rule) -> None:
    controller = situation.make(rule)
    robot, station = situation.world.robots[149], situation.world.pick_stations[0]
    assert benchmark(controller.pick_pod, robot, station) >= 0


@pytest.mark.parametrize("rule", [Nearest, RandomPlace])
def test_psa(benchmark, situation, rule) -> None:
    controller = situation.make(rule)
    assert benchmark(controller.place, situation.world.robots[149]) >= 0


def test_rps_emptiest(benchmark, situation) -> None:
    controller = situation.make(Emptiest)
    bundle = situation.bundle()
    assert benchmark(controller.choose_anew, bundle) >= 0
