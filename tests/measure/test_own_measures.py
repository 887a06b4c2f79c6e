"""A measure in one file outside the tree, wherever runs are made and read."""

from __future__ import annotations

import copy
import pickle
import re
from pathlib import Path

import pandas as pd
import pytest

import rmfs
from rmfs import experiments
from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.experiments.compare import compare
from rmfs.experiments.results import reproducible_table
from rmfs.measure import load_run, registry
from rmfs.measure.dictionary import FOOTPRINT, better_of
from rmfs.measure.registry import find, find_all

SHORT = [(["scenario", "duration_s"], 300), (["scenario", "warmup_s"], 60)]

FILE = """
import time

from rmfs import Column, Measure

class Busiest(Measure):
    columns = (
        Column("pods_used", "int64", "pods", "Pods picked from", better="less"),
        Column("busiest_pod_units", "int64", "units", "Most units from one pod", better="more"),
        Column("looked_at_s", "float64", "s", "When that was found out", measured=True),
    )

    def __init__(self):
        self.units = {}

    def run_started(self, run):
        self.pods = run.layout.pods
        assert run.world.now_s == 0 and run.scenario.duration_s > 0

    def warmup_ended(self, time_s):
        self.units.clear()

    def unit_picked(self, time_s, order, sku, pod, robot, station, late_bound):
        assert 0 <= pod < self.pods
        self.units[pod] = self.units.get(pod, 0) + 1

    def footprint(self, run):
        return {
            "pods_used": len(self.units),
            "busiest_pod_units": max(self.units.values(), default=0),
            "looked_at_s": time.perf_counter(),
        }
"""

DESIGN = """
format = "rmfs-design/1"
name = "own"
seeds = [1, 2]
measures = ["busiest.py:Busiest"]
base = {layout = "basic", scenario = "basic", controllers = "default", "scenario.duration_s" = 300}
factors = {"controllers.psa" = ["nearest", "random"]}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "busiest.py").write_text(FILE)
    (tmp_path / "own.toml").write_text(DESIGN)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def expected(picks: pd.DataFrame) -> tuple[int, int]:
    per_pod = picks.groupby("pod").size()
    return len(per_pod), int(per_pod.max())


def test_in_python_by_class_and_by_name(folder: Path) -> None:
    (by_name, by_class) = (
        rmfs.simulate("basic", "basic", "default", overrides=SHORT, measures=[given])
        for given in ("busiest.py:Busiest", find("busiest.py:Busiest"))
    )
    row = by_name.footprint
    units = by_name.recorder.units.columns()
    picked = pd.DataFrame(units)[units["time_s"] >= 60.0]
    assert (row["pods_used"], row["busiest_pod_units"]) == expected(picked)
    assert by_class.footprint["pods_used"] == row["pods_used"]
    own = ["pods_used", "busiest_pod_units", "looked_at_s"]
    assert [*row.index] == [*(column.name for column in FOOTPRINT), *own]
    assert better_of("pods_used") == "less"


def test_a_measure_can_be_copied_and_saved_with_what_it_knows(folder: Path) -> None:
    run = rmfs.simulate(
        "basic", "basic", "default", overrides=SHORT, measures=["busiest.py:Busiest"]
    )
    (own,) = [measure for measure in run.measures if hasattr(measure, "units")]
    for twin in (copy.deepcopy(own), pickle.loads(pickle.dumps(own))):
        assert twin.units == own.units and twin.units is not own.units
    log = run.recorder.units
    for twin in (copy.deepcopy(log), pickle.loads(pickle.dumps(log))):
        assert all((twin.columns()[name] == values).all() for name, values in log.columns().items())
        twin.add(1.0, 1, 1, 1, 1, 1, False)
        assert len(twin) == len(log) + 1


def test_a_fork_and_a_saved_simulation_take_it_along(folder: Path) -> None:
    given = {"scenario.duration_s": 300, "scenario.warmup_s": 60}
    run = rmfs.Simulation("basic", "basic", set=given, measures=["busiest.py:Busiest"])
    run.run_until(200.0)
    run.save(folder / "file")
    twins = run.fork(), rmfs.Simulation.load(folder / "file")
    own = ["pods_used", "busiest_pod_units"]
    run.run()
    row = run.result().footprint[own]
    assert row["pods_used"] > 0
    for twin in twins:
        twin.run()
        assert twin.result().footprint[own].equals(row)


def test_run_folder_report_and_compare(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--layout", "basic", "--scenario", "basic", "--set", "scenario.duration_s=300"]
    for psa in ("nearest", "random"):
        arguments = [*given, "--set", f"controllers.psa={psa}", "--out", psa]
        assert main(["run", *arguments, "--measure", "busiest.py:Busiest"]) == 0
    printed = capsys.readouterr().out
    assert "pods_used, pods" in printed
    run = load_run(Path("nearest"))
    assert (run.footprint["pods_used"], run.footprint["busiest_pod_units"]) == expected(
        run.table("picks")
    )
    (told,) = run.parameters["measures"]
    assert told["reference"] == f"{folder}/busiest.py:Busiest"
    assert len(told["sha256"]) == 64
    assert pd.read_csv("nearest/footprint.csv")["pods_used"][0] == run.footprint["pods_used"]
    assert main(["report", "nearest"]) == 0
    page = Path("nearest/report.html").read_text()
    assert "busiest_pod_units, units" in page and "Most units from one pod" in page
    (found,) = compare(["nearest", "random"])
    assert "busiest_pod_units" in found.outputs.index
    assert main(["compare", "nearest", "random", "-c", "pods_used"]) == 0
    assert "pods_used" in capsys.readouterr().out


def test_an_experiment_in_worker_processes(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = experiments.plan("own.toml")
    assert not plan.problems
    done = experiments.run(plan, "out", processes=2)
    assert (done.finished, done.failed) == (4, [])
    frame = experiments.load("out")
    assert (frame["busiest_pod_units"] > 0).all() and (frame["pods_used"] > 1).all()
    repeating = reproducible_table(frame)
    assert "pods_used" in repeating and "looked_at_s" not in repeating
    assert main(["experiment", "table", "own.toml", "--out", "out", "--column", "pods_used"]) == 0
    assert "pods used" in capsys.readouterr().out
    # what was planned is read without the measure's file; a changed file is another experiment
    before = plan.arms[0].digest
    Path("busiest.py").write_text(FILE + "\n# changed\n")
    assert experiments.load("out")["pods_used"].equals(frame["pods_used"])
    assert experiments.plan("own.toml").arms[0].digest != before
    assert experiments.plan("own.toml").hash != plan.hash


@pytest.mark.slow
def test_an_experiment_on_dask(folder: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None
    ) as cluster:
        done = experiments.run(experiments.plan("own.toml"), "dask", dask=cluster.scheduler_address)
    assert (done.finished, done.failed) == (4, [])
    experiments.run(experiments.plan("own.toml"), "local", processes=1)
    texts = [reproducible_table(experiments.load(one)).to_csv() for one in ("dask", "local")]
    assert texts[0] == texts[1] and "pods_used" in texts[0]


def test_a_stage_may_stop_by_it(folder: Path) -> None:
    until = """
[[stages]]
name = "all"
until = {column = "pods_used", relative_half_width = 0.9, max_seeds = 3}
"""
    Path("own.toml").write_text(DESIGN + until)
    assert not experiments.plan("own.toml").problems
    Path("own.toml").write_text(DESIGN + until.replace("pods_used", "looked_at_s"))
    with pytest.raises(InputError, match="is a measured time"):
        experiments.plan("own.toml")
    Path("own.toml").write_text(DESIGN + until.replace("pods_used", "pods_unused"))
    with pytest.raises(InputError, match="is not a number of the footprint"):
        experiments.plan("own.toml")


def test_an_installed_one_is_found_by_its_name(folder: Path, monkeypatch) -> None:
    monkeypatch.setattr(registry, "_installed", lambda: {"busiest": f"{folder}/busiest.py:Busiest"})
    assert find("busiest").__name__ == "Busiest"
    with pytest.raises(InputError, match=r"no measure named busyest; did you mean busiest\?"):
        find("busyest")


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ("()", "measure Odd: declares no `columns`"),
        ('("pods_used",)', "'pods_used' is not an rmfs.measure.Column"),
        ('(Column("units_per_h", "float64", "", ""),)', "units_per_h: a column of this name"),
        ('(Column("replication", "int64", "", ""),)', "replication: a column of this name"),
        (
            '(Column("Pods used", "int64", "", ""),)',
            "must consist of lower-case letters, digits and _",
        ),
        (
            '(Column("own", "int", "", ""),)',
            "type 'int' is invalid; valid: int64, Int64, float64, str, bool",
        ),
        ('(Column("x", "int64", "", "", better="high"),)', "better must be more, less or neither"),
    ],
)
def test_what_cannot_be_a_measure_is_refused(folder: Path, columns: str, message: str) -> None:
    code = f"from rmfs import Column, Measure\nclass Odd(Measure):\n    columns = {columns}\n"
    Path("odd.py").write_text(code)
    with pytest.raises(InputError, match=re.escape(message)):
        rmfs.simulate("basic", "basic", "default", measures=[f"{folder}/odd.py:Odd"])


@pytest.mark.parametrize(
    ("returned", "message"),
    [
        ("{}", "x: must be both declared in `columns` and returned by `footprint`"),
        ('{"x": 1, "y": 2}', "y: must be both declared"),
        ('{"x": "many"}', "x: 'many' does not fit its type"),
    ],
)
def test_what_a_measure_says_must_be_what_it_declares(returned: str, message: str) -> None:
    class Odd(rmfs.Measure):
        columns = (rmfs.Column("x", "int64", "", ""),)

        def footprint(self, run):
            return eval(returned)

    short = [(["scenario", "duration_s"], 60)]
    run = rmfs.simulate("basic", "basic", "default", overrides=short, measures=[Odd])
    with pytest.raises(InputError, match=f"measure .*Odd: {message}"):
        _ = run.footprint
    with pytest.raises(InputError, match="Odd also has a column x"):
        find_all([Odd, type("Other", (Odd,), {})])
