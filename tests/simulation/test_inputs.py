"""What a run is made of: files of RAWSim-O serve in `simulate` as on the command line."""

from __future__ import annotations

import json

import pytest
from rawsimo_files import xsett

import rmfs
from rmfs import layout as layouts
from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.simulation.inputs import load_inputs

GENERAL = """<Name>asking</Name><SimulationWarmupTime>0</SimulationWarmupTime>
<SimulationDuration>120</SimulationDuration><Colour>red</Colour>"""
ASKED = """<OverrideBotCountPerOStation>true</OverrideBotCountPerOStation>
<OverrideBotCountPerOStationValue>2</OverrideBotCountPerOStationValue>
<OverrideOutputStationItemPickTime>true</OverrideOutputStationItemPickTime>
<OverrideOutputStationItemPickTimeValue>4.5</OverrideOutputStationItemPickTimeValue>"""


@pytest.fixture
def asking(tmp_path):
    return xsett(tmp_path, general=GENERAL, layout=ASKED)


def test_what_a_scenario_asks_of_the_layout_is_done_and_said(asking):
    told = []
    run = rmfs.simulate(
        "basic", asking, "default", remark=lambda part, note: told.append((part, note))
    )
    assert run.layout.robots == 2 * len(run.layout.pick_stations)
    assert {station.unit_pick_s for station in run.layout.pick_stations} == {4.5}
    assert told == [("scenario", note) for note in run.notes["scenario"]]
    assert any("Colour unknown" in note for _, note in told)
    assert (["layout", "unit_pick_s"], 4.5) in run.overrides


def test_the_user_has_the_last_word(asking):
    own = [(["layout", "unit_pick_s"], 6.0)]
    plan = load_inputs("basic", asking, "default", own).layout
    assert {station.unit_pick_s for station in plan.pick_stations} == {6.0}


def test_a_layout_given_as_an_object_is_asked_too(asking):
    plan = layouts.load("basic")
    asked = load_inputs(plan, asking, "default").layout
    assert asked.robots == 2 * len(plan.pick_stations)
    with pytest.raises(InputError, match="given as an object"):
        load_inputs(plan, asking, "default", [(["layout", "robots"], 3)])


def test_ours_ask_nothing():
    inputs = load_inputs("basic", "basic", "default")
    assert (inputs.overrides, inputs.notes) == ([], {})


def test_remarks_are_printed_and_kept_in_the_run_folder(asking, tmp_path, capsys):
    out = tmp_path / "run"
    arguments = ["run", "--layout", "basic", "--scenario", str(asking), "--out", str(out)]
    assert main(arguments) == 0
    notes = json.loads((out / "run.json").read_text())["notes"]["scenario"]
    assert any("Colour unknown" in note for note in notes)
    printed = capsys.readouterr().err
    assert all(f"rmfs: {asking}: {note}" in printed for note in notes)
