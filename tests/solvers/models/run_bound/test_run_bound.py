"""The bound on whole runs: no run of a warehouse that keeps its rules may pass it."""

import dataclasses
from math import inf

import numpy as np
import pytest
from warehouse_double import Log, Plant, operate

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.run_bound import (
    Orders,
    PickStations,
    Refill,
    RunBound,
    Stock,
    objective,
    single_bounds,
    solve,
    violations,
    visit_legs,
)


def random_plant(seed: int) -> Plant:
    rng = np.random.default_rng(seed)
    picking, refilling = int(rng.integers(1, 4)), int(rng.integers(0, 3))
    stations = picking + refilling
    transfer = rng.uniform(2, 12, stations)
    pick = np.where(np.arange(stations) < picking, rng.uniform(1, 14, stations), transfer)
    limit = int(rng.integers(2, 30))
    return Plant(
        picking,
        transfer,
        pick,
        rng.choice([0.0, 1.0, 9.0], stations),
        rng.uniform(0, 40, stations),
        rng.uniform(0, 40, stations),
        rng.uniform(1, 60, (stations, stations)),
        float(rng.choice([0.0, 2.2])),
        rng.integers(0, limit + 1, int(rng.integers(1, 9))),
        limit,
        int(rng.integers(1, 4)),
        int(rng.integers(1, 9)),
    )


def bound_of(
    plant: Plant, robots: int, duration_s: float, contents: np.ndarray, **orders: float
) -> RunBound:
    split = plant.pick_stations
    legs = visit_legs(plant.from_storage_s, plant.to_storage_s, plant.between_s, plant.lift_s)
    return RunBound(
        duration_s,
        robots,
        PickStations(
            plant.transfer_s[:split],
            plant.pick_s[:split],
            plant.changeover_s[:split],
            legs.inbound_s[:split],
            legs.outbound_s[:split],
            np.full(split, 6),
        ),
        Refill(
            plant.transfer_s[split:],
            legs.inbound_s[split:],
            legs.outbound_s[split:],
            plant.bundle_units,
            plant.bundles_per_visit,
        ),
        Stock(contents, plant.pod_limit),
        Orders(**orders),
    )


@pytest.mark.parametrize("eager", [True, False])
def test_no_run_passes_the_bound_in_any_window(eager: bool) -> None:
    shares = []
    for seed in range(150):
        plant, rng = random_plant(seed), np.random.default_rng(seed)
        robots = int(rng.integers(1, 7))
        log, owner = operate(plant, robots, 900.0, rng, eager=eager)
        for begin, end in ((0.0, 900.0), (60.0, 200.0), (300.0, 900.0), (100.0, 101.0)):
            counts = log.counted(begin, end, plant)
            data = bound_of(plant, robots, end - begin, log.contents(begin, plant, owner))
            solution = solve(data)
            assert not violations(data, counts), (seed, begin, end)
            assert objective(data, counts) <= solution.bound
            shares.append(objective(data, counts) / solution.bound)
    assert max(shares) > 0.99
    assert 0.02 < np.mean(shares) < 0.95


def test_the_bound_is_reached_where_robots_are_scarce_and_where_stations_are() -> None:
    plant = Plant(
        2, np.full(2, 10.0), np.full(2, 3.0), np.zeros(2), np.full(2, 20.0), np.full(2, 20.0),
        np.full((2, 2), inf), 2.0, np.full(400, 50), 50, 1, 1,
    )  # fmt: skip
    for robots in (1, 2, 6):
        log, _ = operate(plant, robots, 40_000.0, np.random.default_rng(0), eager=True)
        data = bound_of(plant, robots, 40_000.0, plant.pods)
        reached = objective(data, log.counted(0.0, 40_000.0, plant)) / solve(data).bound
        assert 0.97 < reached <= 1.0


def test_no_run_that_stores_what_it_picks_passes_the_bound_for_such_runs() -> None:
    shares = []
    for seed in range(150):
        plant, rng = random_plant(seed), np.random.default_rng(seed)
        robots = int(rng.integers(1, 7))
        log, owner = operate(plant, robots, 900.0, rng, eager=bool(seed % 2))
        for begin in range(0, 900, 50):
            for end in range(begin + 100, 901, 100):
                before, after = (
                    log.contents(time, plant, owner).sum() for time in (begin, end + 1e-6)
                )
                if after < before or len(shares) > 400:
                    continue
                counts = log.counted(begin, end, plant)
                data = bound_of(plant, robots, end - begin, log.contents(begin, plant, owner))
                kept = data.keeping_stock()
                assert not violations(kept, counts), (seed, begin, end)
                assert objective(data, counts) <= solve(kept).bound <= solve(data).bound + 1e-6
                if counts.units.sum():
                    shares.append(objective(data, counts) / solve(kept).bound)
    assert len(shares) > 100
    assert max(shares) > 0.9


def test_the_bound_for_runs_that_keep_their_stock_is_reached() -> None:
    """Pods empty at first, filled with six bundles of eight at a time, and emptied again."""
    plant = Plant(
        1, np.full(2, 10.0), np.array([3.0, 10.0]), np.zeros(2), np.full(2, 20.0),
        np.full(2, 20.0), np.full((2, 2), inf), 2.0, np.zeros(400, int), 48, 8, 6,
    )  # fmt: skip
    log, owner = operate(plant, 1, 40_000.0, np.random.default_rng(0), eager=True)
    full = np.full(400, 48)
    data = bound_of(plant, 1, 40_000.0, full)
    counts = log.counted(0.0, 40_000.0, plant)
    assert log.contents(40_000.0, plant, owner).sum() >= 0
    kept = solve(data.keeping_stock()).bound
    # two visits of 44 s of ways, 47 gaps of 10 s, the last unit's 3 s, and six bundles of 10 s
    by_hand = 3600.0 * 48 / (2 * 44 + 47 * 10 + 3 + 6 * 10)
    assert kept == pytest.approx(by_hand, rel=0.005)
    assert 0.97 < objective(data, counts) / kept <= 1.0
    assert kept < 0.9 * solve(data).bound


def one(**changes: object) -> RunBound:
    """One hour, one station of 10 s and 3 s, ample of everything else."""
    arrays = {name: np.array([value]) for name, value in {
        "unit_transfer_s": 10.0, "unit_pick_s": 3.0, "changeover_s": 0.0,
        "inbound_s": 30.0, "outbound_s": 30.0, "order_slots": 6,
    }.items()}  # fmt: skip
    station = {k: np.array([v]) for k, v in changes.items() if k in arrays}
    rest = {k: v for k, v in changes.items() if k not in arrays}
    given = {
        "duration_s": 3600.0,
        "robots": 99,
        "picking": PickStations(**(arrays | station)),
        "refill": Refill([], [], [], 1, 1),
        "stock": Stock(np.full(100, 100), 100),
        "orders": Orders(),
    }
    return RunBound(**(given | rest))  # type: ignore[arg-type]


def test_each_limit_binds_alone() -> None:
    # 3600 s fit 360 gaps of 10 s, so 361 picks
    assert solve(one()).bound == pytest.approx(361.0)
    assert solve(one(unit_pick_s=20.0)).bound == pytest.approx(181.0)
    assert solve(one(orders=Orders(units=17.0))).bound == pytest.approx(17.0)
    assert solve(one(stock=Stock([5, 4], 9))).bound == pytest.approx(9.0)
    # a robot: way in and out 60 s a visit of at most 100 units
    robots = one(robots=1, order_slots=6)
    expected = (3600 + 63) / (10 + (63 - 10) / 100)
    assert solve(robots).bound == pytest.approx(expected)
    # pods change after 2 units and the station waits for 7 s each time
    slow = one(changeover_s=14.0, stock=Stock(np.full(999, 2), 2))
    assert solve(slow).bound == pytest.approx((3600 + 17) / (10 + 7 / 2), rel=1e-6)


def test_refill_adds_what_bundles_bring_and_costs_robot_time() -> None:
    refill = Refill([20.0], [0.0], [0.0], 1, 10)
    # 180 gaps of 20 s, so 181 bundles of one unit
    stocked = one(stock=Stock([50], 100), refill=refill)
    assert solve(stocked).bound == pytest.approx(231.0)
    shared = one(
        robots=1,
        inbound_s=0.0,
        outbound_s=0.0,
        stock=Stock([0], 100),
        refill=Refill([10.0], [0.0], [0.0], 1, 10),
    )
    # without ways each unit takes the robot for 3 s, its bundle for 10 s, and one end lasts 10 s
    assert solve(shared).bound == pytest.approx(3610 / 13)


def test_slots_limit_visits_that_no_order_joins() -> None:
    closed = Orders(largest_order_units=2.0, join_visits=False)
    data = one(robots=1, orders=closed, order_slots=3)
    assert data.visit_units.tolist() == [6.0]
    assert solve(data).bound == pytest.approx((3600 + 63) / (10 + (63 - 10) / 6))
    assert one(robots=1, order_slots=3).visit_units.tolist() == [100.0]


def test_orders_that_need_several_visits_limit_the_pile_on() -> None:
    spread = Orders(largest_order_units=2.0, lone_units=0.0)
    data = one(robots=1, orders=spread, order_slots=3)
    visits = (3600 + 63 - 10 * 6) / (63 - 10 + 60)
    assert solve(data).bound == pytest.approx(6 * (visits + 1), rel=1e-6)


def serve_orders(rng: np.random.Generator, slots: int, largest: int) -> list[tuple[int, int]]:
    """Return (visit, order) of every unit picked at a station where orders may join visits."""
    picks: list[tuple[int, int]] = []
    open_units: dict[int, int] = {}
    created = 0
    for visit in range(int(rng.integers(1, 30))):
        for _ in range(int(rng.integers(0, 12))):
            while len(open_units) < slots and rng.random() < 0.7:
                open_units[created] = int(rng.integers(1, largest + 1))
                created += 1
            if not open_units:
                continue
            order = int(rng.choice(list(open_units)))
            picks.append((visit, order))
            open_units[order] -= 1
            if not open_units[order]:
                del open_units[order]
    return picks


def test_spread_orders_are_as_few_as_the_proof_says() -> None:
    """Inequality 8 on random histories of one station, in random windows."""
    tight = 0.0
    for seed in range(600):
        rng = np.random.default_rng(seed)
        slots, largest = int(rng.integers(1, 5)), int(rng.integers(1, 4))
        picks = serve_orders(rng, slots, largest)
        if not picks:
            continue
        visits_of = {order: {v for v, o in picks if o == order} for _, order in picks}
        first, last = sorted(rng.integers(0, len(picks) + 1, 2))
        window = picks[first:last]
        lone = sum(len(visits_of[order]) == 1 for _, order in window)
        visits = len({visit for visit, _ in window})
        limit = lone + largest * slots * (visits + 1)
        assert len(window) <= limit
        tight = max(tight, (len(window) - lone) / (largest * slots * (visits + 1)))
    assert tight > 0.5


def test_the_bound_is_below_what_each_resource_alone_allows() -> None:
    for seed in range(100):
        plant = random_plant(seed)
        data = bound_of(plant, 1 + seed % 5, 3600.0, plant.pods, units=float(seed * 7))
        bound = solve(data).bound
        for alone in single_bounds(data).values():
            assert bound <= alone * (1 + 1e-9) + 1e-9


def test_more_of_anything_never_lowers_the_bound() -> None:
    for seed in range(60):
        plant = random_plant(seed)
        data = bound_of(plant, 2, 1800.0, plant.pods, units=400.0)
        bound = solve(data).bound
        more = [
            dataclasses.replace(data, robots=3),
            dataclasses.replace(data, stock=Stock(plant.pods + 1, plant.pod_limit + 1)),
            dataclasses.replace(data, orders=Orders(units=500.0)),
        ]
        for richer in more:
            assert solve(richer).bound >= bound * (1 - 1e-9)


def test_the_reported_bound_is_a_dual_value_however_early_the_solver_stops() -> None:
    for seed in range(40):
        plant = random_plant(seed)
        data = bound_of(plant, 2, 1800.0, plant.pods)
        full, stopped = solve(data), solve(data, limits=Limits(iterations=0))
        assert full.status is Status.OPTIMAL
        assert full.objective <= full.bound * (1 + 1e-7)
        assert full.gap < 1e-6
        assert stopped.bound >= full.objective * (1 - 1e-9)


def test_nothing_can_be_picked_without_robots_pods_stations_or_slots() -> None:
    for data in (
        one(robots=0),
        one(stock=Stock([], 0)),
        one(order_slots=0),
        one(picking=PickStations([], [], [], [], [], [])),
    ):
        assert solve(data).bound == pytest.approx(0.0, abs=1e-9)
        assert single_bounds(data)["stations"] >= 0.0


def test_legs_share_ways_between_stations_in_halves() -> None:
    legs = visit_legs([20.0, 50.0], [10.0, 50.0], [[0.0, 30.0], [40.0, 0.0]], 2.0)
    assert legs.inbound_s.tolist() == [20.0, 15.0]
    assert legs.outbound_s.tolist() == [12.0, 20.0]
    alone = visit_legs([20.0], [10.0], [[0.0]], 2.0)
    assert (alone.inbound_s[0], alone.outbound_s[0]) == (22.0, 12.0)


def test_invalid_input_is_refused_by_field() -> None:
    with pytest.raises(ModelError, match="duration_s"):
        one(duration_s=0.0)
    with pytest.raises(ModelError, match="robots"):
        one(robots=-1)
    with pytest.raises(ModelError, match="unit_transfer_s"):
        one(unit_transfer_s=0.0, unit_pick_s=0.0)
    with pytest.raises(ModelError, match="inbound_s"):
        one(inbound_s=inf)
    with pytest.raises(ModelError, match="units"):
        one(orders=Orders(units=-1.0))
    with pytest.raises(ModelError, match="largest_pod_units"):
        Stock([5], 4)
    with pytest.raises(ModelError, match="bundle_units"):
        Refill([], [], [], 0, 1)


def test_the_double_counts_what_it_wrote_down() -> None:
    plant = random_plant(3)
    log = Log([(1.0, 0, 0), (2.0, 0, 0), (9.0, 0, 1)], [])
    counts = log.counted(0.0, 5.0, plant)
    assert (counts.units[0], counts.visits[0]) == (2.0, 1.0)
