"""A kind of station in one file outside the tree: in runs, designs, other processes, the viewer."""

from __future__ import annotations

import json
import shutil
from collections import Counter
from pathlib import Path

import pandas as pd
import pytest

import rmfs
from rmfs import experiments
from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.experiments.results import reproducible_table
from rmfs.layout import load
from rmfs.layout.explicit import read_json, save_json
from rmfs.measure import load_run
from rmfs.simulation.run import Simulation
from rmfs.view import scene
from rmfs.world import verify

EXAMPLE = Path(__file__).resolve().parents[2] / "docs" / "examples" / "quality_check.py"

CHECKS = """
[other_stations.check]
kind = "quality_check.py:QualityCheck"
north = 1

[other_stations.check.parameters]
every = 3
check_s = 25.0
"""

SHORT = [(["scenario", "warmup_s"], 0.0), (["scenario", "duration_s"], 900.0)]


@pytest.fixture
def checked(tmp_path: Path) -> Path:
    """A layout with a check, beside the file of its kind."""
    shutil.copy(EXAMPLE, tmp_path / "quality_check.py")
    basic = Path(rmfs.__file__).parent / "shipped" / "layouts" / "basic.toml"
    path = tmp_path / "checked.toml"
    path.write_text(basic.read_text("utf-8") + CHECKS, "utf-8")
    return path


class Visits(rmfs.measure.Observer):
    """Pods in the order in which they came to stations, and the time each stayed."""

    def __init__(self) -> None:
        self.came: list[tuple[int, int]] = []
        self.stays: list[tuple[int, float]] = []
        self._since: dict[int, float] = {}

    def visit_started(self, time_s, station, pod, robot):
        self.came.append((station, pod))
        self._since[station] = time_s

    def visit_ended(self, time_s, station, pod, robot):
        self.stays.append((station, time_s - self._since.pop(station)))


def test_every_nth_pod_goes_from_the_pick_station_to_the_check(checked):
    visits = Visits()
    run = rmfs.simulate(
        checked, "basic", "default", seed=1, overrides=SHORT, observers=[visits], trace=True
    )
    assert run.check().collisions == 0
    due = [pod for station, pod in visits.came if station < 2][2::3]
    at_check = [pod for station, pod in visits.came if station == 4]
    assert len(at_check) > 5
    assert Counter(at_check) <= Counter(due)
    # the last ones may still be served, or be on their way
    assert len(due) - len(at_check) <= 4
    assert {round(stay_s, 6) for station, stay_s in visits.stays if station == 4} == {25.0}
    assert run.footprint["pods_checked"] == len(at_check)
    stations = run.world.stations
    assert stations[4].passed in (len(at_check), len(at_check) - 1)
    verify(run.world)


@pytest.mark.parametrize(
    "rules",
    [
        {"ta": "swarm"},
        {"ta": "constant-ratio"},
        {"ta": "random", "pps": "dummy"},
        {"ta": "brute-force", "pps": "dummy", "psa": "dummy"},
        {"poa": "dummy", "ta": "pile-on", "pps": "dummy"},
        {"poa": "dummy", "ta": "planning", "pps": "dummy"},
        {"ta": "dispatch"},
    ],
)
def test_rules_that_know_nothing_of_checks_go_on(checked, rules):
    overrides = [*SHORT, *((["controllers", key, "name"], name) for key, name in rules.items())]
    run = rmfs.simulate(checked, "basic", "default", seed=2, overrides=overrides)
    assert run.footprint["pods_checked"] > 0
    assert run.footprint["units_picked"] > 0
    verify(run.world)


def test_a_copy_goes_on_as_the_original(checked):
    simulation = Simulation(
        load(checked),
        rmfs.scenario.load("basic", [(path[1:], value) for path, value in SHORT]),
        rmfs.control.load("default"),
        seed=1,
    )
    simulation.run_until(400.0)
    twin = simulation.fork()
    simulation.run()
    twin.run()
    one, other = simulation.world, twin.world
    assert one.stations[4].passed == other.stations[4].passed > 0
    assert one.stations[4] is not other.stations[4]
    assert one.units_picked == other.units_picked


def test_the_command_writes_columns_colour_and_layout(checked, tmp_path, capsys):
    shown = ["--set", "scenario.warmup_s=0", "--set", "scenario.duration_s=600"]
    given = ["run", "--layout", str(checked), "--scenario", "basic", *shown]
    every = ["--set", "layout.other_stations.check.parameters.every=2"]
    assert main([*given, *every, "--check", "--trace", "--out", str(tmp_path / "out")]) == 0
    folder = load_run(tmp_path / "out")
    assert folder.footprint["pods_checked"] > 0
    assert list(folder.table("stations")["kind"])[-1] == "check"
    layout = folder.layout
    assert layout.other_stations[0].kind.parameters.every == 2
    head = scene.head(
        layout,
        names={},
        seed=0,
        warmup_s=0.0,
        end_s=600.0,
        title="",
        details=[],
    )
    told = head["stations"][-1]
    assert (told["kind"], told["letter"]) == ("check", "Q")
    for theme, shade in {"light": "#441C51", "dark": "#C4A3CF"}.items():
        assert head["themes"][theme]["task"]["check"] == "#7B3294"
        assert head["themes"][theme]["stations"][-1] == shade
    tasks = folder.events.query("kind == 'task' and detail == 'check'")
    assert set(tasks["station"]) == {4}
    assert len(scene.of_run(folder)) > 1000


def test_an_explicit_layout_keeps_kind_and_parameters(checked, tmp_path):
    layout = load(checked)
    save_json(layout, tmp_path / "explicit.json")
    again = read_json(tmp_path / "explicit.json")
    (one,), (other,) = layout.other_stations, again.other_stations
    assert (one.waypoint, one.queue, one.radius_m) == (other.waypoint, other.queue, other.radius_m)
    assert type(one.kind) is type(other.kind)
    assert one.kind.parameters == other.kind.parameters
    assert again.stations[-1] is other


@pytest.fixture
def design(checked: Path, tmp_path: Path) -> Path:
    path = tmp_path / "design.toml"
    path.write_text(
        f"""
format = "rmfs-design/1"
name = "checks"
seeds = [1]

[base]
layout = "{checked.name}"
scenario = "basic"
controllers = "default"
"scenario.warmup_s" = 0
"scenario.duration_s" = 600

[factors]
"layout.other_stations.check.parameters.every" = [2, 6]
""",
        "utf-8",
    )
    return path


def test_a_design_runs_it_in_worker_processes_and_its_report_tells_of_it(design, tmp_path):
    out = tmp_path / "x"
    assert main(["experiment", "run", str(design), "--jobs", "2", "--out", str(out)]) == 0
    frame = experiments.load(out)
    assert len(frame) == 2
    often, seldom = frame["pods_checked"]
    assert often > seldom > 0
    column = ["--column", "pods_checked"]
    assert main(["experiment", "report", str(design), "--out", str(out), *column]) == 0
    (page,) = out.rglob("*.html")
    assert "pods checked" in page.read_text("utf-8").lower()


@pytest.mark.slow
def test_a_design_runs_it_on_dask(design, tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None
    ) as cluster:
        done = experiments.run(
            experiments.plan(design), tmp_path / "dask", dask=cluster.scheduler_address
        )
    assert (done.finished, done.failed) == (2, [])
    experiments.run(experiments.plan(design), tmp_path / "local", processes=1)
    tables = [reproducible_table(experiments.load(tmp_path / one)) for one in ("dask", "local")]
    pd.testing.assert_frame_equal(*tables)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("QualityCheck", "Nothing"), "other_stations.check.kind: .* has no class Nothing"),
        (("quality_check.py", "missing.py"), "other_stations.check.kind: .* no file"),
        (
            ("stations.check", "stations.other"),
            "has the name 'check': use the table other_stations.check",
        ),
        (("every = 3", "every = 0"), "other_stations.check.parameters: every"),
        (("every = 3", "evry = 3"), "unknown key evry; did you mean every"),
        (("north = 1", "north = 9"), "north side has room for"),
        (
            ('kind = "quality_check.py:QualityCheck"', 'kind = "check"'),
            "no kind of station is named check",
        ),
    ],
)
def test_what_is_wrong_is_named(checked, change, message):
    checked.write_text(checked.read_text("utf-8").replace(*change), "utf-8")
    with pytest.raises(InputError, match=message) as error:
        load(checked)
    assert str(error.value).startswith(str(checked))


def test_every_part_of_the_shipped_kinds_is_there():
    from rmfs.layout.kinds import PICK, REPLENISHMENT
    from rmfs.world.stations import Station
    from rmfs.world.tasks import TASKS, Task

    for kind in (PICK, REPLENISHMENT):
        assert kind.part("task", Task) in TASKS
        assert issubclass(kind.part("state", Station), Station)
        assert hasattr(kind.part("service", object), "go_on")


def test_layout_json_of_other_layouts_says_nothing_of_other_kinds(tmp_path):
    save_json(load("basic"), tmp_path / "basic.json")
    assert "other_stations" not in json.loads((tmp_path / "basic.json").read_text("utf-8"))
