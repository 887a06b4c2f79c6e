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


def test_other_due_times_have_no_classes():
    given = {"scenario.duration_s": 300.0, "scenario.orders.due": {"mode": "normal"}}
    footprint = rmfs.simulate("small", "small", "sequ", set=given).footprint
    assert footprint["on_time_share"] == 1
    assert footprint[["on_time_urgent_share", "on_time_ordinary_share"]].isna().all()
