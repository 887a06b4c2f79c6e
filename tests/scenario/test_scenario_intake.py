"""Backlogs, batches, needed bundles and returns, as a simulation meets them."""

from __future__ import annotations

import numpy as np
import pytest
from scenario_tools import DAY_US, SIGNIFICANT, SITE, FakeState, drive, scenario, times_s
from scipy import stats

from rmfs.errors import InputError
from rmfs.scenario import (
    BundleSource,
    OrderSource,
    SkuSet,
    StreamRecorder,
    bundle_intake,
    load,
    order_intake,
    sku_set,
)
from rmfs.scenario.clock import NEVER_US, US_PER_H, US_PER_S

HOUR = 3600.0
NIGHT = {"periods_s": [[0, 6 * HOUR], [22 * HOUR, 24 * HOUR]]}


def test_a_backlog_of_orders_is_topped_up_from_stock(skus: SkuSet):
    given = scenario(demand={"orders": 50})
    intake = order_intake(given, skus, SITE, seed=1)
    state = FakeState()
    come = list(intake_now(intake, 0, state))
    source = OrderSource(given.orders, skus, 1)
    plenty = np.full(len(skus), 10**6)
    contents = [source.draw(k, plenty) for k in range(50)]
    assert [(order.skus, order.units) for order in come] == [(d.skus, d.units) for d in contents]
    assert [order.due_s for order in come] == [content.due_offset_s for content in contents]
    assert intake.next_us == NEVER_US
    state.waiting_orders -= 3
    assert len(list(intake_now(intake, 7 * US_PER_S, state))) == 3


def intake_now(intake, now_us: int, state: FakeState):
    for thing in intake.due(now_us, state):
        if hasattr(thing, "skus"):
            state.waiting_orders += 1
        else:
            state.waiting_bundles += 1
            state.load += thing.space
            state.incoming[thing.sku] += thing.units
        yield thing


def test_an_order_that_nothing_can_serve_is_tried_again_later(skus: SkuSet):
    intake = order_intake(scenario(demand={"retry_s": 30}), skus, SITE, seed=1)
    state = FakeState(uncommitted=np.zeros(1000, np.int64))
    assert list(intake_now(intake, US_PER_S, state)) == []
    assert intake.next_us == 31 * US_PER_S
    state.uncommitted += 9
    assert list(intake_now(intake, 2 * US_PER_S, state)) == []
    assert intake.next_us == 31 * US_PER_S
    assert len(list(intake_now(intake, 31 * US_PER_S, state))) == 200


def test_a_backlog_rests_in_down_periods(skus: SkuSet):
    given = scenario(demand={"orders": 5, "down": NIGHT}, replenishment={"down": NIGHT})
    for intake, waiting in (
        (order_intake(given, skus, SITE, 1), "waiting_orders"),
        (bundle_intake(given, skus, SITE, 1), "waiting_bundles"),
    ):
        state = FakeState(load=0.0)
        assert list(intake_now(intake, 0, state)) == []
        assert intake.next_us == 6 * US_PER_H
        assert len(list(intake_now(intake, 6 * US_PER_H, state))) >= 5
        assert intake.next_us == NEVER_US
        setattr(state, waiting, 0)
        state.load = 0.0
        assert list(intake_now(intake, 23 * US_PER_H, state)) == []
        assert intake.next_us == 30 * US_PER_H


def test_a_backlog_of_bundles_keeps_below_its_limit(skus: SkuSet):
    given = scenario(replenishment={"pause_by_stock": False, "load_limit_share": 0.9})
    state = FakeState()
    come = list(intake_now(bundle_intake(given, skus, SITE, 1), 0, state))
    assert 900 - skus.bundle_space.max() < state.load <= 900
    source = BundleSource(skus, 1)
    assert [tuple(bundle)[1:-1] for bundle in come] == [
        tuple(source.draw(k)) for k in range(len(come))
    ]


def test_returns_are_single_units(skus: SkuSet):
    table = {"bundles": 2000, "pause_by_stock": False, "load_limit_share": 1e6}
    come = {
        share: drive(
            bundle_intake(scenario(replenishment=table | {"return_share": share}), skus, SITE, 1),
            FakeState(),
            0,
        )
        for share in (0.0, 0.3, 1.0)
    }
    assert [b.sku for b in come[0.0]] == [b.sku for b in come[0.3]] == [b.sku for b in come[1.0]]
    single = [b for b in come[0.3] if b.units == 1]
    assert stats.binomtest(len(single), 2000, 0.3).pvalue > SIGNIFICANT
    for bundle in come[1.0]:
        assert (bundle.units, bundle.space) == (1, skus.space_per_unit[bundle.sku])
    for bundle, full in zip(come[0.3], come[0.0], strict=True):
        assert bundle == full or bundle.units == 1


def test_batches_of_orders_fill_the_backlog_up(skus: SkuSet):
    batches = {"fill_to": [[10 * HOUR, 30]], "add": [[10 * HOUR, 2], [12 * HOUR, 1]]}
    given = scenario(2 * 86400, demand={"orders": 20, "batches": batches})
    state = FakeState()
    come = times_s(drive(order_intake(given, skus, SITE, 1), state, 2 * DAY_US)) / HOUR
    hours, numbers = np.unique(come, return_counts=True)
    # 4 stations: up to 120, then 8 and 4 more; nothing leaves, so the second day only adds
    assert dict(zip(hours.tolist(), numbers.tolist(), strict=True)) == {
        0.0: 20,
        10.0: 108,
        12.0: 4,
        34.0: 8,
        36.0: 4,
    }


def test_batches_may_count_all_stations_together(skus: SkuSet):
    batches = {"cycle_s": 60, "fill_to": [[30, 30]], "per_station": False}
    given = scenario(demand={"orders": 20, "batches": batches})
    come = drive(order_intake(given, skus, SITE, 1), FakeState(), 100 * US_PER_S)
    assert times_s(come).tolist() == [0.0] * 20 + [30.0] * 10


def test_batches_do_not_shift_the_other_orders(skus: SkuSet):
    poisson = {"mode": "poisson", "initial_orders": 3}
    plain = drive(order_intake(scenario(demand=poisson), skus, SITE, 1), FakeState(), DAY_US)
    batches = {"cycle_s": 60, "add": [[30, 5]]}
    mixed = drive(
        order_intake(scenario(demand=poisson | {"batches": batches}), skus, SITE, 1),
        FakeState(),
        3600 * US_PER_S,
    )
    added = [order for order in mixed if order.time_us % (60 * US_PER_S) == 30 * US_PER_S]
    assert [order for order in mixed if order not in added] == plain
    assert len(added) == 60 * 20


def test_batches_of_bundles_lift_the_load(skus: SkuSet):
    batches = {"fill_to": [[7 * HOUR, 0.9]], "add": [[8 * HOUR, 3]]}
    given = scenario(replenishment={"bundles": 0, "batches": batches})
    state = FakeState()
    intake = bundle_intake(given, skus, SITE, 1)
    assert drive(intake, state, 7 * US_PER_H)
    assert 900 <= state.load < 900 + skus.bundle_space.max()
    assert len(list(intake_now(intake, 8 * US_PER_H, state))) == 3


def test_a_batch_of_which_stock_can_serve_no_more_ends(skus: SkuSet):
    batches = {"fill_to": [[10, 30]]}
    given = scenario(demand={"orders": 0, "batches": batches})
    state = FakeState(uncommitted=np.zeros(1000, np.int64))
    assert drive(order_intake(given, skus, SITE, 1), state, DAY_US) == []


def needed(skus: SkuSet, state: FakeState, **table):
    table = {"mode": "needed", "bundles": 10, "load_limit_share": 2.0} | table
    intake = bundle_intake(scenario(replenishment=table), skus, SITE, 1)
    return intake, list(intake_now(intake, 0, state))


def test_needed_bundles_cover_what_orders_lack(few_skus: SkuSet):
    state = FakeState(5, uncommitted=np.array([5, -1, 0, -9, 2]), load=100.0)
    _, come = needed(few_skus, state)
    assert [(bundle.sku, bundle.units) for bundle in come] == [(3, 4), (3, 4), (1, 4), (3, 4)]
    assert (state.uncommitted + state.incoming >= 0).all()


def test_needed_bundles_know_a_reorder_point(few_skus: SkuSet):
    state = FakeState(5, uncommitted=np.array([5, 2, 3, 9, 8]), load=100.0)
    _, come = needed(few_skus, state, reorder_below_units=3)
    assert [bundle.sku for bundle in come] == [1]


def test_needed_bundles_are_limited_in_number_and_load(few_skus: SkuSet):
    state = FakeState(5, uncommitted=np.full(5, -100), load=100.0)
    _, come = needed(few_skus, state, bundles=3)
    assert len(come) == 3
    state = FakeState(5, uncommitted=np.full(5, -100), load=995.0)
    intake, come = needed(few_skus, state, load_limit_share=1.0)
    assert len(come) == 1
    assert intake.next_us == 60 * US_PER_S
    state.load = 0.0
    assert list(intake_now(intake, 59 * US_PER_S, state)) == []
    assert len(list(intake_now(intake, 60 * US_PER_S, state))) == 9


def test_a_recorder_keeps_what_comes(skus: SkuSet):
    recorder = StreamRecorder()
    given = scenario(demand={"mode": "poisson"}, replenishment={"mode": "poisson"})
    orders = drive(order_intake(given, skus, SITE, 1, recorder), FakeState(), DAY_US)
    bundles = drive(bundle_intake(given, skus, SITE, 1, recorder), FakeState(), DAY_US)
    kept = recorder.orders.build()
    assert len(kept) == len(recorder.orders) == len(orders)
    assert kept.time_us.tolist() == [order.time_us for order in orders]
    assert [kept.lines(k) for k in range(len(kept))] == [(o.skus, o.units) for o in orders]
    assert kept.due_us.tolist() == [order.due_us for order in orders]
    stored = recorder.bundles.build()
    columns = zip(stored.time_us, stored.sku, stored.units, strict=True)
    assert [tuple(map(int, row)) for row in columns] == [tuple(b)[:3] for b in bundles]
    assert len(stored) == len(recorder.bundles)


def test_orders_of_more_lines_than_popular_skus_are_refused(few_skus: SkuSet):
    lines = {"mean": 5, "sd": 0, "min": 5, "max": 5}
    given = scenario(skus={"count": 5}, orders={"lines": lines}, demand={"mode": "poisson"})
    with pytest.raises(InputError, match="exceeds the 4 SKUs with a popularity above zero"):
        order_intake(given, few_skus, SITE, 1)


@pytest.mark.parametrize(
    ("tables", "problem"),
    [
        ({"demand": {"down": {"periods_s": []}}}, "down.periods_s: Tuple should have at least"),
        ({"demand": {"down": {"periods_s": [[5, 3]]}}}, r"\[5, 3\] does not"),
        ({"demand": {"down": {"periods_s": [[0, 86400]]}}}, "must leave at least 1 s of the cycle"),
        ({"demand": {"down": {"cycle_s": 0, "periods_s": [[0, 1]]}}}, "down.cycle_s: "),
        ({"demand": {"batches": {}}}, "fill_to or add must list at least one batch"),
        ({"demand": {"batches": {"add": [[90000, 1]]}}}, "times must be less than cycle_s"),
        ({"demand": {"batches": {"add": [[9, 1], [9, 1]]}}}, "times must be in ascending order"),
        ({"replenishment": {"batches": {"fill_to": [[9, 3]]}}}, "fill_to.0.1: Input should be"),
        ({"demand": {"mode": "poisson", "orders": 3}}, "unknown key demand.orders; did you mean"),
        (
            {"demand": {"mode": "poisson", "profile": {"kind": "steps", "weights": [0, 0]}}},
            "profile.weights: at least one weight must be positive",
        ),
        (
            {"demand": {"mode": "poisson", "profile": {"kind": "steps", "starts_s": [0]}}},
            r"profile.starts_s: must have as many entries as weights \(24\)",
        ),
        ({"demand": {"mode": "poisson", "profile": {"kind": "stairs"}}}, "kind: must be one of"),
        ({"demand": {"mode": "stream", "file": "none.csv"}}, "demand.file: no such file"),
        ({"demand": {"mode": "stream", "file": "/etc/hostname"}}, "must end in .csv or .parquet"),
        ({"skus": {"count": 3, "affinity": {"share": 0.5, "pairs": 4}}}, "have only 3 pairs"),
    ],
)
def test_wrong_tables_are_one_clear_error(tables, problem: str):
    with pytest.raises(InputError, match=problem):
        scenario(**tables)


def test_each_table_may_be_overridden(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('format = "rmfs-scenario/1"\nduration_s = 600\n[demand]\nmode = "poisson"\n')
    loaded = load(
        path,
        [
            (["demand", "orders_per_h"], 12),
            (["demand", "profile"], {"kind": "steps", "weights": [1, 2, 3]}),
            (["demand", "down", "periods_s"], [[0, 60]]),
            (["replenishment", "mode"], "needed"),
            (["replenishment", "reorder_below_units"], 4),
            (["skus", "affinity", "share"], 0.5),
            (["time_of_day_s"], 60),
        ],
    )
    assert loaded.demand.orders_per_h == 12
    assert loaded.demand.profile.weights == (1, 2, 3)
    assert loaded.demand.down.periods_s == ((0, 60),)
    assert loaded.replenishment.reorder_below_units == 4
    assert sku_set(loaded.skus).affinity.share == 0.5
