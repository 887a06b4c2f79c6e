"""On-time shares and lateness of real runs, recomputed order by order, packed and not."""

from __future__ import annotations

import numpy as np
import pytest

import rmfs

DUE = {"mode": "priority", "urgent_offset_s": 240.0, "ordinary_offset_s": 700.0}
SHORT = {"scenario.warmup_s": 300.0, "scenario.duration_s": 1200.0, "scenario.orders.due": DUE}
PACKING = {"packers": 1, "order_s": 12.0, "bypass": False, "travel": {"constant_s": 60.0}}
BEGIN, END = 300.0, 1500.0


@pytest.mark.parametrize("packing", [None, PACKING], ids=["picked", "packed"])
def test_every_order_counts_once(packing):
    given = SHORT if packing is None else SHORT | {"scenario.packing": packing}
    run = rmfs.simulate("small", "small-arrivals", "sequ", seed=1, set=given)
    orders = run.table("orders").set_index("order")
    done = orders["completed_s"].to_dict()
    due, created = orders["due_s"].to_dict(), orders["created_s"].to_dict()
    if packing is not None:
        parcels = run.table("parcels").set_index("order")
        done = dict.fromkeys(done, np.nan) | parcels["packed_s"].to_dict()
        due |= parcels["due_s"].to_dict()
        created |= parcels["created_s"].to_dict()
        assert len(done) > len(orders)  # some were picked in the warm-up
    kept, lateness, overdue = {240.0: [], 700.0: []}, [], 0
    for order, done_s in done.items():
        own = kept[round(due[order] - created[order], 4)]
        if done_s == done_s:
            assert BEGIN <= done_s <= END
            own.append(done_s <= due[order])
            lateness.append(done_s - due[order])
        elif due[order] < END:
            own.append(False)
            overdue += 1
    footprint = run.footprint
    assert footprint["on_time_share"] == pytest.approx(np.mean(kept[240.0] + kept[700.0]))
    assert footprint["on_time_urgent_share"] == pytest.approx(np.mean(kept[240.0]))
    assert footprint["on_time_ordinary_share"] == pytest.approx(np.mean(kept[700.0]))
    assert footprint["lateness_p95_s"] == pytest.approx(np.percentile(lateness, 95))
    assert footprint["lateness_max_s"] == pytest.approx(max(lateness))
    assert footprint["orders_overdue_end"] == overdue > 0
    waiting = [created[order] for order, done_s in done.items() if done_s != done_s]
    assert footprint["oldest_order_end_s"] == pytest.approx(END - min(waiting))
    assert 0 < footprint["on_time_urgent_share"] < 1


@pytest.mark.parametrize(("urgent_s", "ordinary_s"), [(700.0, 240.0), (400.0, 400.0)])
def test_urgent_orders_need_not_be_due_sooner(urgent_s, ordinary_s):
    offsets = {"urgent_offset_s": urgent_s, "ordinary_offset_s": ordinary_s}
    given = SHORT | {"scenario.orders.due": DUE | offsets}
    run = rmfs.simulate("small", "small-arrivals", "sequ", seed=1, set=given)
    rows = run.table("priorities").set_index("priority")["orders_done"]
    orders = run.table("orders")
    orders = orders[orders["completed_s"].notna()]
    offset_s = orders["due_s"] - orders["created_s"]
    if urgent_s == ordinary_s:
        # nothing tells which orders are urgent
        assert rows.to_dict() == {"all": len(orders)}
        assert np.isnan(run.footprint["on_time_urgent_share"])
    else:
        number = {"urgent": (offset_s > 500.0).sum(), "ordinary": (offset_s < 500.0).sum()}
        assert rows.to_dict() == number
        assert min(number.values()) > 0


CLASSES = [
    {"name": "express", "share": 0.2, "offset_s": 240.0, "weight": 4.0},
    {"name": "prime", "share": 0.3, "offset_s": 500.0},
    {"name": "ordinary", "share": 0.5, "offset_s": 900.0, "weight": 0.5},
]


@pytest.mark.parametrize("packing", [None, PACKING], ids=["picked", "packed"])
def test_service_by_class(packing):
    given = SHORT | {"scenario.orders.due": {"mode": "classes", "classes": CLASSES}}
    given |= {} if packing is None else {"scenario.packing": packing}
    run = rmfs.simulate("small", "small-arrivals", "sequ", seed=1, set=given)
    table = run.table("priorities").set_index("priority")
    orders = run.table("orders").set_index("order")
    done, created, due = orders["completed_s"], orders["created_s"], orders["due_s"]
    if packing is not None:
        parcels = run.table("parcels").set_index("order")
        done = parcels["packed_s"].reindex(orders.index.union(parcels.index))
        created = parcels["created_s"].combine_first(created)
        due = parcels["due_s"].combine_first(due)
    in_time = counted = 0.0
    for one in CLASSES:
        row = table.loc[one["name"]]
        own = ((due - created).round(3) == one["offset_s"]).reindex(done.index)
        late = (done - due)[own].dropna()
        overdue = int((done.isna() & own & (due < END)).sum())
        assert row["weight"] == one.get("weight", 1.0)
        assert row["orders_done"] == len(late) > 0
        assert row["orders_overdue_end"] == overdue
        assert row["orders"] == len(late) + overdue
        assert row["on_time_share"] == pytest.approx((late <= 0).sum() / row["orders"])
        assert row["lateness_mean_s"] == pytest.approx(late.mean())
        assert row["lateness_p95_s"] == pytest.approx(np.percentile(late, 95))
        assert row["lateness_max_s"] == pytest.approx(late.max())
        assert row["late_by_mean_s"] == pytest.approx(late.clip(lower=0).mean())
        cycle = (done - created)[own].dropna()
        assert row["cycle_mean_s"] == pytest.approx(cycle.mean())
        assert row["cycle_p95_s"] == pytest.approx(np.percentile(cycle, 95))
        in_time += row["weight"] * (late <= 0).sum()
        counted += row["weight"] * row["orders"]
    assert list(table.index) == ["express", "prime", "ordinary"]
    footprint = run.footprint
    assert footprint["on_time_urgent_share"] == table.loc["express", "on_time_share"]
    assert footprint["on_time_weighted_share"] == pytest.approx(in_time / counted)
    assert set(orders["priority"]) == set(table.index)


def test_weights_decide_in_planning_and_tardiness_cost():
    """With nearly all weight on a class, more of it is on time than with equal weights."""
    due = {"scenario.orders.due": {"mode": "classes", "classes": CLASSES}, "layout.robots": 5}
    same = [{**one, "weight": 1.0} for one in CLASSES]
    heavy = [{**one, "weight": 50.0 if one["name"] == "prime" else 1.0} for one in CLASSES]
    for ways in (
        {"controllers": "planning", "late": {"controllers.ta.late_s": 200}},
        {"controllers": "default", "late": {"controllers.poa.name": "tardiness-cost"}},
    ):
        shares = []
        for classes in (same, heavy):
            told = {"mode": "classes", "classes": classes}
            given = SHORT | due | ways["late"] | {"scenario.orders.due": told}
            run = rmfs.simulate("small", "small-arrivals", ways["controllers"], seed=1, set=given)
            shares.append(run.table("priorities").set_index("priority").loc["prime"])
        assert shares[1]["on_time_share"] > shares[0]["on_time_share"] + 0.05


def test_other_due_times_have_no_classes():
    given = {"scenario.duration_s": 300.0, "scenario.orders.due": {"mode": "normal"}}
    footprint = rmfs.simulate("small", "small", "sequ", set=given).footprint
    assert footprint["on_time_share"] == 1
    assert footprint[["on_time_urgent_share", "on_time_ordinary_share"]].isna().all()
    assert footprint["on_time_weighted_share"] == 1
