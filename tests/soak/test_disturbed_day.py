"""24 hours of a three-tier warehouse in which something goes wrong every few minutes."""

import pytest
from ledger import Ledger

import rmfs
from rmfs.measure import tables
from rmfs.world import verify

DAY_S = 86_400.0
HOUR_S = 3_600.0


@pytest.mark.slow
def test_a_day_of_breakdowns():
    """129 robots (43 a tier), a breakdown every ten minutes, an elevator out of use for an hour.

    Pods are stored on any tier, so that cabins are busy most of the time. No collision, no order
    lost, no robot stuck.
    """
    ledger = Ledger()
    overrides = {
        "layout.robots": 43,
        "controllers.psa.name": "random",
        "controllers.psa.prefer_same_tier": False,  # robots ride elevators
        "scenario.duration_s": DAY_S,
        "scenario.disturbances.breakdowns": {"every_s": 600.0, "lasting_s": 120.0},
        "scenario.disturbances.elevators_out": [[1, 8 * HOUR_S, 9 * HOUR_S]],
    }
    run = rmfs.simulate(
        "study-tiers",
        "pp-minimal",
        "default",
        seed=1,
        overrides=[(key.split("."), value) for key, value in overrides.items()],
        observers=[ledger],
        trace=True,
    )
    assert run.layout.robots == 129
    verify(run.world)
    ledger.check()
    print(run.footprint[["orders_completed", "disturbances", "disturbed_s", "wall_s"]])
    assert 100 < run.footprint["disturbances"] < 200
    assert run.footprint["disturbed_s"] > 100 * 60
    orders = tables.orders(tables.Logs(run.recorder))
    waiting_s = DAY_S - orders.loc[orders["completed_s"].isna(), "assigned_s"]
    assert waiting_s.max() < HOUR_S
    assert run.traffic.motion()["riding_s"].sum() > DAY_S
    trips = run.traffic.trips()
    assert ((trips["t1_us"] - trips["t0_us"]) / 1e6).max() < HOUR_S / 2
    for hour in range(24):
        in_hour = (trips["t1_us"] > hour * HOUR_S * 1e6) & (
            trips["t1_us"] <= (hour + 1) * HOUR_S * 1e6
        )
        moved = set(trips["robot"][in_hour].tolist())
        assert moved == set(range(129)), f"hour {hour}: {set(range(129)) - moved} did nothing"
    report = run.check()
    print(report.summary())
    assert report.ok, report.summary()
