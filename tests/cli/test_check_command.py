"""`rmfs check`: what a run would refuse, and whether a fleet gets the energy it uses."""

from __future__ import annotations

import pytest

from rmfs.cli import main

PLACE = [
    "--set=layout.other_stations.charger.kind=charger",
    "--set=layout.other_stations.charger.north=1",
]
BATTERY = "--set=scenario.energy.battery.capacity_wh=300"


def told(capsys, *arguments, code=0):
    assert main(["check", *arguments]) == code
    output = capsys.readouterr()
    return output.out.splitlines() if code == 0 else output.err.splitlines()


def test_what_goes_together_is_ok(capsys):
    assert told(capsys) == ["default, default, default: ok"]


def test_energy_without_batteries_is_told(capsys):
    line, ok = told(capsys, "--set=scenario.energy.robot_kg=100")
    assert line.startswith("energy: 16 robots draw 480 W at standstill and about ")
    assert line.endswith("their energy is unlimited")
    assert ok.endswith(": ok")


def test_a_fleet_that_uses_more_than_all_chargers_give(capsys):
    lines = told(capsys, *PLACE, BATTERY)
    assert lines[0].endswith("; chargers supply at most 1000 W")
    assert lines[1].startswith("energy: in the long run about 8")
    assert lines[1].endswith("W are missing at full work")


def test_a_fleet_whose_electronics_alone_use_more_is_refused(capsys):
    (line,) = told(
        capsys, *PLACE, BATTERY, "--set=layout.other_stations.charger.parameters.power_w=300",
        code=2,
    )  # fmt: skip
    assert "all chargers together supply only 300 W: 180 W are missing in the long run" in line


def test_where_only_waypoints_charge_nobody_can_be_sent(capsys):
    lines = told(capsys, BATTERY, "--set=scenario.energy.inductive.power_w=300")
    assert lines[1].endswith("cannot be sent to charge and strands")
    assert len(lines) == 3


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (["scenario.energy.robot_kg=-1"], "energy.robot_kg"),
        (["scenario.energy.pod_kg=-1"], "energy.pod_kg"),
        (["scenario.energy.goods_kg_per_space=-0.5"], "energy.goods_kg_per_space"),
        (["controllers.ca.below_share=0.9"], "below_share = 0.9 must be less than until_share"),
        (["scenario.energy.battery.capacity_wh=100"], "batteries cannot be charged"),
    ],
)
def test_bad_input_gets_one_line(capsys, given, says):
    (line,) = told(capsys, *(f"--set={one}" for one in given), code=2)
    assert says in line
