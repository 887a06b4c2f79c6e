"""RAWSim-O's controller configurations: what each element becomes, and what is said of the rest."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmfs.cli import main
from rmfs.control.pp.far import Far
from rmfs.control.problems import Problem
from rmfs.control.settings import load, load_with_notes
from rmfs.errors import InputError
from rmfs.rawsimo.control import read_xconf

REFERENCE = Path(__file__).resolve().parents[3] / "shared" / "reference" / "instances"
HEAD = '<ControlConfiguration xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"><Name>x</Name>'


def written(folder: Path, body: str = "") -> Path:
    path = folder / "x.xconf"
    path.write_text(f"{HEAD}{body}</ControlConfiguration>")
    return path


def block(tag: str, kind: str, **elements: object) -> str:
    suffix = f"{tag.removesuffix('Config')}Configuration"
    inner = "".join(f"<{name}>{value}</{name}>" for name, value in elements.items())
    return f'<{tag} xsi:type="{kind}{suffix}">{inner}</{tag}>'


def test_an_empty_file_is_what_rawsimo_does_by_default(tmp_path: Path):
    ours, theirs = load("default"), load(written(tmp_path))
    for problem in Problem:
        if problem is not Problem.PP:
            assert theirs.choices[problem] == ours.choices[problem], problem
    assert theirs.choices[Problem.PP].controller is Far


def test_every_value_of_a_block_arrives(tmp_path: Path):
    balanced = block(
        "TaskAllocationConfig",
        "Balanced",
        BotReallocationTimeout=45,
        WeightInputStations=3,
        WeightOutputStations=4,
        WeightRepositioning=0.5,
        BotsPerStationLimit=7,
        ExtendSearch="true",
        ExtendedSearchRadius=5,
        SearchAll="true",
        RepositionBeforeRest="false",
        RestLocationOrderType="Nearest",
    )
    storage = block(
        "PodStorageConfig",
        "Turnover",
        ClassBorders="0.2,1.0",
        PodDisposeRule="OStationNearestManhattan",
        StorageLocationClassRule="OutputStationDistanceShortestPath",
    )
    shifts = (
        "<Shifts><Shift><Key>0</Key><Value>true</Value></Shift>"
        "<Shift><Key>3600</Key><Value>false</Value></Shift></Shifts><LoopTime>7200</LoopTime>"
    )
    activation = (
        '<StationActivationConfig xsi:type="WorkShiftStationActivationConfiguration">'
        f"{shifts}</StationActivationConfig>"
    )
    read = load(written(tmp_path, balanced + storage + activation)).choices
    assert read[Problem.TA].parameters.model_dump() == {
        "period_s": 45.0,
        "replenishment_weight": 3.0,
        "pick_weight": 4.0,
        "reposition_weight": 0.5,
        "robots_per_station": 7,
        "other_stations": True,
        "search_radius_m": 5.0,
        "search_all": True,
        "reposition_before_rest": False,
        "rest": "nearest",
    }
    pods = read[Problem.PSA].parameters.model_dump()
    assert (pods["class_borders"], pods["within_class"]) == ((0.2, 1.0), "nearest-to-station")
    assert (pods["metric"], pods["place_metric"]) == ("manhattan", "path")
    assert read[Problem.SA].parameters.model_dump() == {
        "shifts": ({"at_s": 0.0, "on": True}, {"at_s": 3600.0, "on": False}),
        "loop_s": 7200.0,
    }


@pytest.mark.parametrize(
    ("tag", "kind", "problem", "ours"),
    [
        ("OrderBatchingConfig", "Foresight", "poa", "foresight"),
        ("OrderBatchingConfig", "Queue", "poa", "queue"),
        ("OrderBatchingConfig", "Related", "poa", "related"),
        ("OrderBatchingConfig", "NearBestPod", "poa", "near-best-pod"),
        ("OrderBatchingConfig", "Workload", "poa", "workload"),
        ("OrderBatchingConfig", "LinesInCommon", "poa", "lines-in-common"),
        ("OrderBatchingConfig", "Default", "poa", "random"),
        ("ItemStorageConfig", "Turnover", "rps", "turnover"),
        ("ItemStorageConfig", "Correlative", "rps", "correlative"),
        ("ItemStorageConfig", "LeastDemand", "rps", "least-demand"),
        ("PodStorageConfig", "Fixed", "psa", "fixed"),
        ("PodStorageConfig", "Cache", "psa", "cache"),
        ("PodStorageConfig", "Utility", "psa", "utility"),
        ("RepositioningConfig", "Cache", "repositioning", "cache"),
        ("RepositioningConfig", "CacheDropoff", "repositioning", "cache-drop-off"),
        ("RepositioningConfig", "Utility", "repositioning", "utility"),
        ("TaskAllocationConfig", "ConstantRatio", "ta", "constant-ratio"),
        ("TaskAllocationConfig", "Swarm", "ta", "swarm"),
        ("TaskAllocationConfig", "Random", "ta", "random"),
        ("StationActivationConfig", "BacklogThreshold", "sa", "backlog-threshold"),
        ("StationActivationConfig", "ConstantRatio", "sa", "constant-ratio"),
        ("MethodManagementConfig", "Random", "mm", "random"),
        ("MethodManagementConfig", "Scheduled", "mm", "scheduled"),
    ],
)
def test_every_method_has_its_rule(tmp_path: Path, tag: str, kind: str, problem: str, ours: str):
    read, notes = load_with_notes(written(tmp_path, block(tag, kind)))
    assert read.choices[Problem(problem)].name == ours
    assert not any("unknown" in note for note in notes)


def test_what_is_dead_or_unknown_is_named(tmp_path: Path):
    body = block("ReplenishmentBatchingConfig", "Random", Reactive="true", Novelty=1)
    notes = read_xconf(written(tmp_path, body + "<Extra/>")).notes
    assert "ReplenishmentBatchingConfig: Reactive not used: RAWSim-O no longer supports it" in notes
    assert any(note.startswith("ReplenishmentBatchingConfig: Novelty unknown") for note in notes)
    assert any(note.startswith("Extra unknown") for note in notes)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (block("TaskAllocationConfig", "Concept"), "TaskAllocationConfig: type Concept"),
        (block("PodStorageConfig", "Nearest", PodDisposeRule="Far"), "PodDisposeRule: must be one"),
        (
            block("TaskAllocationConfig", "Balanced", BotsPerStationLimit="many"),
            "BotsPerStationLimit: must be a finite number",
        ),
    ],
)
def test_wrong_values_are_one_clear_error(tmp_path: Path, body: str, message: str):
    with pytest.raises(InputError, match=message):
        load(written(tmp_path, body))


def test_import_writes_a_set_that_says_the_same(tmp_path: Path, capsys):
    body = block("PodStorageConfig", "Random") + block("PathPlanningConfig", "Dummy", Clocking=1)
    path = written(tmp_path, body)
    target = tmp_path / "ours.toml"
    assert main(["controllers", "import", str(path), "--out", str(target)]) == 0
    assert "Dummy is replaced by time-windows" in capsys.readouterr().err
    assert load(target).choices == load(path).choices
    assert main(["controllers", "import", str(path), "--out", str(target)]) == 2


@pytest.mark.parametrize(
    ("method", "elements", "expected"),
    [
        ("FAR", {}, {"name": "far", "period_s": 1.0, "wait_s": 2.0, "reroute": True}),
        (
            "FAR",
            {"Clocking": 3, "evadingStrategy": "EvadeToNextNode", "NoBackEvading": "false"},
            {"name": "far", "period_s": 3.0, "reroute": False, "avoid_evading_back": False},
        ),
        ("WHCAvStar", {"LengthOfAWindow": 20}, {"name": "whca-v", "window_s": 20.0}),
        ("WHCAnStar", {}, {"name": "whca-n", "window_s": 30.0, "period_s": 1.0}),
        ("BCP", {"BiasedCostAmount": 6}, {"name": "bcp", "bias_m": 6.0}),
        ("CBS", {"SearchMethod": "BestFirst"}, {"name": "cbs"}),
        ("ODID", {"MaxNodeCountPerAgent": 750}, {"name": "od-id", "nodes_per_robot": 750}),
        ("PAS", {"MaxPriorities": 3}, {"name": "pas", "priorities": 3, "window_s": 30.0}),
    ],
)
def test_robots_drive_by_the_planner_that_the_file_names(
    tmp_path: Path, method: str, elements: dict[str, object], expected: dict[str, object]
):
    path = written(tmp_path, block("PathPlanningConfig", method, **elements))
    table = read_xconf(path).table["pp"]
    assert expected.items() <= table.items()
    assert table["runs_granted"] == 1
    assert load(path).choices[Problem.PP].controller.parameters_model is not None


@pytest.mark.skipif(not REFERENCE.is_dir(), reason="needs the published files")
def test_every_published_configuration_is_read_whole():
    paths = sorted(REFERENCE.glob("**/*.xconf"))
    assert len(paths) > 20
    for path in paths:
        read, notes = load_with_notes(path)
        assert len(read.choices) == len(Problem)
        assert not any("unknown, left out" in note for note in notes), path
