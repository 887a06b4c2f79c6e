"""Energy of whole runs: pods weigh what is on them, and the tables agree."""

from __future__ import annotations

import numpy as np
import pytest

import rmfs
from rmfs.measure.dictionary import reproducible

SHORT = {"layout.robots": 16, "scenario.warmup_s": 120, "scenario.duration_s": 900}
ON = {**SHORT, "scenario.energy.robot_kg": 120}


@pytest.fixture(scope="module")
def run():
    return rmfs.simulate("default", "default", seed=1, set=ON)


def test_counting_energy_changes_nothing_else(run):
    without = rmfs.simulate("default", "default", seed=1, set=SHORT).footprint
    columns = [column for column in reproducible("footprint") if not column.startswith("energy")]
    assert run.footprint[columns].equals(without[columns])
    assert without.filter(like="energy").isna().all()


def test_the_tables_add_up(run):
    footprint, robots = run.footprint, run.table("robots")
    assert robots["energy_wh"].sum() == pytest.approx(footprint["energy_kwh"] * 1e3, rel=1e-12)
    assert run.series["energy_wh"].sum() == pytest.approx(footprint["energy_kwh"] * 1e3, rel=1e-9)
    parts = [footprint[f"energy_{part}_kwh"] for part in ("drive", "turn", "lift", "standby")]
    whole = sum(parts) - footprint["energy_recuperated_kwh"]
    assert footprint["energy_kwh"] == pytest.approx(whole, rel=1e-12)
    assert footprint["energy_wh_per_unit"] == pytest.approx(
        footprint["energy_kwh"] * 1e3 / footprint["units_picked"]
    )
    trips = run.table("trips")["energy_wh"]
    assert 0 < trips.sum() < robots["energy_wh"].sum()


def test_orders_share_what_their_visits_cost(run):
    """All that robots drew until their last visit, warm-up included, is somebody's."""
    per_order = run.recorder.energy.per_order
    drawn = sum(per_order.values()) / 3600
    ever = run.recorder.energy.final["ever_used_j"].sum() / 3600
    assert 0.5 * ever < drawn <= ever  # replenishment has the rest
    orders = run.table("orders")
    done = orders[orders["completed_s"] < run.end_s - 60]  # visits end, and are shared, a bit later
    assert (done["energy_wh"] > 0).all()


def test_pods_weigh_what_is_on_them():
    """With goods of no weight all is lighter; twice the weight of goods costs more."""
    drawn = [
        rmfs.simulate(set={**SHORT, "scenario.energy.goods_kg_per_space": kg}).footprint
        for kg in (0.0, 0.5, 1.0)
    ]
    drive = np.diff([one["energy_drive_kwh"] for one in drawn])
    assert (drive > 0).all()
    assert drive[0] == pytest.approx(drive[1], rel=1e-6)  # linear in the mass
    assert np.diff([one["energy_lift_kwh"] for one in drawn]) == pytest.approx(
        drive * 0 + np.diff([one["energy_lift_kwh"] for one in drawn])[0]
    )


def test_a_preset_gives_what_is_not_given():
    energy = rmfs.scenario.load(
        "default", [(["energy", "preset"], "light"), (["energy", "pod_kg"], 70)]
    )
    assert (energy.energy.robot_kg, energy.energy.pod_kg, energy.energy.standby_w) == (60, 70, 5)


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("robot_kg", -1, "greater than 0"),
        ("drive_efficiency", 1.5, "less than or equal to 1"),
        ("preset", "heavy", "standard"),
        ("robot_mass", 1, "robot_kg"),
    ],
)
def test_bad_numbers_get_one_line(key, value, says):
    with pytest.raises(rmfs.errors.InputError, match=says) as error:
        rmfs.simulate(set={f"scenario.energy.{key}": value})
    assert f"energy.{key}" in str(error.value)
    assert "\n" not in str(error.value)
