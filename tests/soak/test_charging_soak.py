"""Half a day with batteries, disturbances and plug-in places that fail: nobody is lost."""

from __future__ import annotations

import pytest

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
    )
    verify(run.world)
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
