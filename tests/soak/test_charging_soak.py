"""Half a day, and a week, with batteries, disturbances and places that fail: nobody is lost."""

from __future__ import annotations

import pytest
from ledger import Ledger

import rmfs
from rmfs.world import verify


@pytest.mark.slow
def test_half_a_day_with_failing_chargers():
    run = rmfs.simulate(
        "default",
        "default",
        seed=5,
        set={
            "layout.robots": 32,
            "layout.other_stations.charger": {"kind": "charger", "within": 8},
            "scenario.warmup_s": 0,
            "scenario.duration_s": 12 * 3600,
            "scenario.energy.battery": {"capacity_wh": 500, "initial_least_share": 0.3},
            "scenario.disturbances": {
                "breakdowns": {"every_s": 1800, "lasting_s": 120},
                "slow": {"every_s": 3600, "lasting_s": 600, "speed_share": 0.5},
                "chargers": {"every_s": 3600, "lasting_s": 1800},
            },
        },
        trace=True,
    )
    verify(run.world)
    assert run.check().ok
    footprint = run.footprint
    strandings = run.world.batteries.strandings
    assert footprint["robots_stranded"] == len(strandings)
    assert footprint["battery_level_least_share"] > 0.05 or strandings
    # energy is in balance: what is drawn is charged, but for what was in the batteries
    drawn, charged = footprint["energy_kwh"], footprint["energy_charged_kwh"]
    assert abs(drawn - charged) < 32 * 0.5
    assert 1 < footprint["battery_cycles_mean"] < 5
    hours = run.series["units_picked"].groupby(run.series["time_s"] // 7200).sum()
    assert hours.iloc[1:-1].min() > 0.8 * hours.iloc[1:-1].max()  # no standstill at any time


DAY_S = 86_400.0
CAPACITY_WH = 500.0


@pytest.mark.slow
def test_a_week_of_96_robots(capsys):
    """Orders that come at random, 16 places of which one is out of order every other half-hour.

    Whoever strands is counted and rescued, every order is served, energy is in balance, no two days
    differ much, and batteries age as the energy that went through them says. Half an hour of one
    core.
    """
    days, ledger = 7, Ledger()
    run = rmfs.simulate(
        "large",
        "large-arrivals",
        seed=5,
        set={
            "layout.robots": 96,
            "layout.other_stations.charger": {
                "kind": "charger",
                "within": 16,
                "parameters": {"power_w": 1500.0},
            },
            "scenario.warmup_s": 0,
            "scenario.duration_s": days * DAY_S,
            "scenario.demand.orders_per_h": 1400,
            "scenario.replenishment": {"mode": "needed"},
            "scenario.energy.battery": {"capacity_wh": CAPACITY_WH, "initial_least_share": 0.3},
            "scenario.disturbances": {
                "breakdowns": {"every_s": 1800, "lasting_s": 120},
                "slow": {"every_s": 3600, "lasting_s": 600, "speed_share": 0.5},
                "chargers": {"every_s": 3600, "lasting_s": 1800},
            },
        },
        observers=[ledger],
    )
    verify(run.world)
    ledger.check()
    found = run.footprint
    stranded = run.world.batteries.strandings
    assert found["robots_stranded"] == len(stranded)
    assert len(run.world.batteries.stranded) <= len(stranded)
    # every order is served: none waits that is older than a few hours
    oldest = min((order.created_s for order in run.world.orders), default=run.end_s)
    assert run.end_s - oldest < 4 * 3600
    assert found["orders_completed"] > run.world.orders_created - 1000
    drawn, charged = found["energy_kwh"], found["energy_charged_kwh"]
    assert abs(drawn - charged) < 96 * CAPACITY_WH / 1000
    cycles = found["battery_cycles_mean"]
    assert cycles == pytest.approx(drawn * 1000 / 96 / CAPACITY_WH, rel=1e-9)
    by_day = run.series["units_picked"].groupby((run.series["time_s"] - 1) // DAY_S).sum()
    assert by_day.min() > 0.95 * by_day.max()
    with capsys.disabled():
        print(
            f"\n{days} days, 96 robots: {len(stranded)} stranded, {found['orders_completed']:.0f} "
            f"of {run.world.orders_created} orders completed, {found['charges']:.0f} charges, "
            f"{drawn:.0f} kWh drawn, {charged:.0f} kWh charged, {cycles:.1f} cycles"
        )
