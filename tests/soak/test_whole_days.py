"""24 simulated hours: one, two and three times the robots of the default layout, and shifts."""

import pytest

import rmfs
from rmfs.measure import tables
from rmfs.measure.checker import check
from rmfs.measure.footprints import all_tables
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


HOUR_S = 3600.0


@pytest.mark.slow
def test_a_day_of_shifts():
    """Stations work from 6 h to 22 h, and the doors are open then; at night all rests."""
    controllers = [(["controllers", "sa", "name"], "work-shifts")]
    run = rmfs.simulate("basic", "shifts", "default", seed=1, overrides=controllers)
    made = all_tables(run)
    series, stations, bundles = made["series"], made["stations"], tables.Logs(run.recorder).bundles
    # the run begins at 5 h, and is measured from 6 h on for a day
    clock_h = (series["time_s"] / HOUR_S + 5.0).to_numpy()
    assert (clock_h[0] * 60, clock_h[-1]) == (pytest.approx(6 * 60 + 1), pytest.approx(30.0))
    # what was at a station is finished at the beginning of the night
    night = clock_h > 23
    assert series["units_picked"][night].sum() == 0
    # the last minute ends when the doors open again
    shut = (clock_h > 22) & (clock_h < 30)
    assert series["orders_created"][shut].sum() == 0
    assert series["bundles_created"][shut].sum() == 0
    for hour in range(6, 22):
        now = (clock_h > hour) & (clock_h <= hour + 1)
        assert series["units_picked"][now].sum() > 100, hour
    assert stations["active_share"].to_numpy() == pytest.approx(16 / 24, abs=1e-3)
    # the bundles of 7 h come at once
    by_minute = bundles.groupby((bundles["created_s"] // 60).astype(int)).size()
    assert by_minute.idxmax() == 120
    assert run.traffic.blocked() == []
