"""24 simulated hours on the default layout with one, two and three times its robots."""

import pytest

import rmfs
from rmfs.measure import tables
from rmfs.measure.checker import check
from rmfs.world import verify

DAY_S = 86_400.0


@pytest.mark.slow
@pytest.mark.parametrize("robots", [32, 64, 96])
def test_a_day(robots):
    """Safe throughout, nobody waits for ever, every order at a station is served."""
    overrides = [
        (["scenario", "duration_s"], DAY_S),
        (["scenario", "warmup_s"], 0.0),
        (["layout", "robots"], robots),
    ]
    run = rmfs.simulate("default", "default", "default", seed=1, overrides=overrides, trace=True)
    verify(run.world)
    report = check(run.layout, run.traffic.trace(), until_us=round(DAY_S * 1e6))
    assert report.ok, report.summary()
    assert run.traffic.blocked() == []
    orders = tables.orders(tables.Logs(run.recorder))
    waiting_s = DAY_S - orders.loc[orders["completed_s"].isna(), "assigned_s"]
    assert waiting_s.max() < 3600
    assert orders["throughput_time_s"].max() < 2 * 3600
    trips = run.traffic.trips()
    assert ((trips["t1_us"] - trips["t0_us"]) / 1e6).max() < 1800
    for hour in range(24):
        begun, ended = hour * 3600e6, (hour + 1) * 3600e6
        in_hour = (trips["t1_us"] > begun) & (trips["t1_us"] <= ended)
        assert in_hour.sum() > 500, f"hour {hour}"
    assert run.footprint["units_score"] > 0.98
