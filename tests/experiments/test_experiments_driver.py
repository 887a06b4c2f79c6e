"""The driver: what is run, what is not run again, what happens when things go wrong."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
import stand_in
from stand_in import Inline, work, work_that_fails_for_random

from rmfs import experiments
from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.experiments.design.planning import PlanError
from rmfs.experiments.results import reproducible_table
from rmfs.experiments.running.driver import Silent, drive, progress_of
from rmfs.experiments.running.job import Outcome
from rmfs.experiments.running.local import LocalProcesses
from rmfs.experiments.store import Store
from rmfs.instances import ROOT

CODE = {"rmfs_version": "", "git_commit": "", "code": ""}


class Notes(Silent):
    """A watcher that remembers what it was told."""

    def __init__(self) -> None:
        self.remarks: list[str] = []
        self.plans: list[tuple[int, int]] = []

    def planned(self, total, finished):
        self.plans.append((total, finished))

    def remark(self, text):
        self.remarks.append(text)


def table(folder) -> str:
    return reproducible_table(experiments.load(folder)).to_csv(index=False)


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path / "out")


def test_results_are_sorted_and_complete(design, store):
    plan = experiments.plan(design(keep=["series"]))
    engine = Inline()
    done = drive(plan, store, engine)
    assert (done.wanted, done.finished, done.ran, done.failed) == (12, 12, 12, [])
    assert engine.closed
    frame = experiments.load(store.folder)
    assert list(frame.columns[:6]) == [
        *("arm", "layout.robots", "controllers.psa", "stage", "replication", "layout")
    ]
    assert list(frame["arm"].unique()) == [arm.name for arm in plan.arms]
    assert list(frame["replication"]) == [1, 2, 3] * 4
    assert list(frame["layout.robots"]) == [8] * 6 + [16] * 6
    assert set(frame["layout"]) == {"basic"}
    assert frame["collisions"].isna().all()
    series = experiments.load(store.folder, table="series")
    assert len(series) == 48
    assert list(series["seed"].iloc[:12]) == [1] * 4 + [2] * 4 + [3] * 4
    with pytest.raises(InputError, match="table heat is not kept"):
        experiments.load(store.folder, table="heat")


def test_finished_runs_are_never_repeated(design, store):
    plan = experiments.plan(design())
    drive(plan, store, Inline())
    again = Inline()
    done = drive(plan, store, again)
    assert (again.done, done.ran, done.finished) == ([], 0, 12)
    more = Inline()
    drive(experiments.plan(design(seeds=[2, 3, 4])), store, more)
    assert sorted({name[-1] for name in more.done}) == ["4"] and len(more.done) == 4
    # a seed that is no longer asked for is not lost, but does not count
    assert set(experiments.load(store.folder)["replication"]) == {2, 3, 4}
    drive(plan, store, Inline(after=0))
    assert set(experiments.load(store.folder)["replication"]) == {1, 2, 3}


def test_an_interruption_loses_nothing_and_changes_nothing(design, store, tmp_path):
    plan = experiments.plan(design())
    with pytest.raises(KeyboardInterrupt):
        drive(plan, store, Inline(after=5))
    assert len(experiments.load(store.folder)) == 5
    assert progress_of(plan, store).finished == 5
    engine = Inline(slots=1)
    drive(plan, store, engine)
    assert len(engine.done) == 7
    drive(plan, Store(tmp_path / "whole"), Inline())
    assert table(store.folder) == table(tmp_path / "whole")


def test_results_can_be_read_while_the_experiment_runs(design, store):
    plan = experiments.plan(design())
    seen = []

    def look(job):
        seen.append(len(experiments.load(store.folder)))
        return work(job)

    drive(plan, store, Inline(do=look))
    assert seen == list(range(12))


def test_a_changed_input_is_noticed(design, store, tmp_path):
    scenario = (ROOT / "scenarios" / "basic.toml").read_text()
    (tmp_path / "own.toml").write_text(scenario)
    base = {"layout": "basic", "scenario": "own.toml", "controllers": "default"}
    path = design(base=base)
    drive(experiments.plan(path), store, Inline())
    (tmp_path / "own.toml").write_text(scenario.replace("orders = 200", "orders = 201"))
    notes, engine = Notes(), Inline()
    changed = experiments.plan(path)
    drive(changed, store, engine, notes)
    assert len(engine.done) == 12
    assert any("12 finished runs of 4 arms were made with other inputs" in r for r in notes.remarks)
    assert len(experiments.load(store.folder)) == 12
    # put back, the first results count again
    (tmp_path / "own.toml").write_text(scenario)
    back = Inline()
    drive(experiments.plan(path), store, back)
    assert back.done == []


def test_an_input_that_changes_under_way_fails_the_run(design, tmp_path):
    from rmfs.experiments.running.execute import execute

    scenario = (ROOT / "scenarios" / "basic.toml").read_text()
    (tmp_path / "own.toml").write_text(scenario)
    base = {"layout": "basic", "scenario": "own.toml", "controllers": "default"}
    plan = experiments.plan(design(base=base))
    job = plan.job(plan.arms[0], 1)
    (tmp_path / "own.toml").write_text(scenario.replace("orders = 200", "orders = 201"))
    outcome = execute(job)
    assert outcome.footprint is None
    assert "own.toml: changed since the plan was made" in outcome.error


def test_runs_of_other_code_are_told(design, store, monkeypatch):
    plan = experiments.plan(design())
    drive(plan, store, Inline())
    other = {"rmfs_version": "9", "git_commit": "f" * 40, "code": "other"}
    monkeypatch.setattr("rmfs.experiments.running.driver.code", lambda: other)
    notes = Notes()
    drive(plan, store, Inline(), notes)
    assert any("12 finished runs were made with another version" in r for r in notes.remarks)


def test_a_failing_run_is_recorded_and_the_rest_goes_on(design, store):
    plan = experiments.plan(design())
    done = drive(plan, store, Inline(do=work_that_fails_for_random))
    assert (done.finished, len(done.failed)) == (10, 2)
    lost = experiments.failures(store.folder)
    assert sorted(lost["arm"]) == ["robots=16,psa=random", "robots=8,psa=random"]
    assert set(lost["error"]) == {"ValueError: a robot is lost"}
    assert set(lost["traceback"]) == {"Traceback: somewhere"}
    assert len(experiments.load(store.folder)) == 10
    assert len(progress_of(plan, store).failed) == 2
    # the next call tries again, and what was lost is made good
    engine = Inline()
    assert drive(plan, store, engine).failed == []
    assert len(engine.done) == 2
    assert experiments.failures(store.folder).empty
    assert len(experiments.load(store.folder)) == 12


def test_a_worker_that_is_killed_is_replaced(design, store, tmp_path):
    marks = tmp_path / "marks"
    marks.mkdir()
    plan = experiments.plan(design())
    notes = Notes()
    drive(plan, store, local(partial(stand_in.work_that_dies_once, marks)), notes)
    assert len(experiments.load(store.folder)) == 12
    assert sum("killed by SIGKILL; begun again" in remark for remark in notes.remarks) == 4
    drive(plan, Store(tmp_path / "whole"), Inline())
    assert table(store.folder) == table(tmp_path / "whole")


def test_a_run_whose_worker_always_dies_is_given_up(design, store):
    plan = experiments.plan(design(factors=None))
    done = drive(plan, store, local(stand_in.work_that_always_dies))
    assert (done.finished, done.failed) == (2, [("base", 2)])
    assert "ended with code 3" in experiments.failures(store.folder)["error"][0]


def local(do) -> LocalProcesses:
    return LocalProcesses(2, do)


def test_closing_ends_what_runs():
    from rmfs.experiments.running.job import Job

    engine = LocalProcesses(1, stand_in.work_without_end)
    job = Job("d", "h", "a", "0" * 64, 1, 1, {}, [], "instant", False, False, (), {})
    engine.submit(job)
    (pid,) = engine.pids
    assert engine.wait(0.2) == []
    engine.close()
    assert not alive(pid)


def alive(pid: int) -> bool:
    import psutil

    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def test_workers_have_one_thread_each(design, store):
    engine = LocalProcesses(1, stand_in.work_that_tells_threads)
    plan = experiments.plan(design(factors=None, seeds=[1]))
    drive(plan, store, engine)
    told = json.loads(experiments.failures(store.folder)["error"][0])
    assert told["OMP_NUM_THREADS"] == told["OPENBLAS_NUM_THREADS"] == "1"
    assert told["sigint"] == "ignored"


def test_two_drivers_do_not_share_a_folder(design, store):
    plan = experiments.plan(design())
    with store.locked(), pytest.raises(InputError, match="another process runs this experiment"):
        drive(plan, Store(store.folder), Inline())


def test_a_plan_with_problems_is_not_run(design, store):
    plan = experiments.plan(design(factors={"layout.robts": [1]}))
    with pytest.raises(PlanError, match="unknown key robts"):
        drive(plan, store, Inline())
    assert not store.folder.exists()


def test_small_files_are_merged(design, store):
    plan = experiments.plan(design())
    drive(plan, store, Inline())
    before = table(store.folder)
    store.merge(at_least=2)
    assert [path.name[:7] for path in (store.folder / "runs").glob("*.parquet")] == ["merged-"]
    assert table(store.folder) == before
    # a double, as an interruption between merging and clearing away would leave it
    job = plan.job(plan.arms[0], 1)
    store.add(job, work(job), CODE)
    assert table(store.folder) == before
    assert store.finished() == {plan.job(arm, r).key for arm in plan.arms for r in (1, 2, 3)}


def test_merging_again_loses_no_run(design, store):
    """Two runs are made again, one of them the first of those merged before."""
    plan = experiments.plan(design())
    drive(plan, store, Inline())
    store.merge(at_least=2)
    jobs = sorted((plan.job(arm, r) for arm in plan.arms for r in (1, 2, 3)), key=lambda j: j.key)
    for job in (jobs[0], jobs[-1]):
        store.add(job, work(job), CODE)
    store.merge(at_least=2)
    assert store.finished() == {job.key for job in jobs}


def test_the_row_of_a_repeated_run_is_that_of_the_last_time(design, store):
    """The rows belong to the same runs as the tables, also if earlier ones were merged."""

    def slower(job):
        done = work(job)
        return replace(done, footprint=done.footprint.assign(units_per_h=1.0), elapsed_s=2.0)

    drive(experiments.plan(design()), store, Inline())
    store.merge(at_least=2)
    drive(experiments.plan(design(keep=["series"])), store, Inline(do=slower))
    for _ in range(2):
        assert set(experiments.load(store.folder)["units_per_h"]) == {1.0}
        assert set(store.rows(["elapsed_s"])["elapsed_s"]) == {2.0}
        assert set(store.rows(["elapsed_s"])) == {"run", "elapsed_s"}
        store.merge(at_least=2)


def test_a_file_is_read_again_only_if_it_was_replaced(design, store, monkeypatch):
    plan = experiments.plan(design())
    drive(plan, store, Inline())
    opened = []
    real = pq.ParquetFile
    monkeypatch.setattr(pq, "ParquetFile", lambda path: opened.append(path.stem) or real(path))
    reading = Store(store.folder)
    before = reading.rows()
    assert len(opened) == len(before) == 12
    assert reading.finished() == set(before["run"]) and reading.rows().equals(before)
    assert len(opened) == 12
    for columns in (["elapsed_s"], ["no_such_column"]):
        assert reading.rows(columns).equals(Store(store.folder).rows(columns))
    opened.clear()
    job = plan.job(plan.arms[0], 2)
    again = work(job)
    store.add(job, replace(again, footprint=again.footprint.assign(units_per_h=1.0)), CODE)
    after = reading.rows().set_index("run")
    assert opened == [job.key] and after["units_per_h"][job.key] == 1.0
    store.merge(at_least=2)
    assert set(reading.rows()["run"]) == set(before["run"])


def test_what_is_half_written_is_never_seen(design, store):
    plan = experiments.plan(design())
    drive(plan, store, Inline(do=work))
    left = store.folder / "runs" / ".abc.parquet.x1y2"
    left.write_text("half")
    assert len(experiments.load(store.folder)) == 12
    drive(plan, store, Inline())
    assert not left.exists()


def test_a_table_that_is_wanted_later_is_made_later(design, store):
    drive(experiments.plan(design()), store, Inline())
    engine = Inline()
    drive(experiments.plan(design(keep=["series"])), store, engine)
    assert len(engine.done) == 12
    assert len(experiments.load(store.folder, table="series")) == 48


def test_an_arm_with_another_name_keeps_its_results(design, store):
    arms = [{"name": "few", "layout.robots": 8}, {"name": "many", "layout.robots": 16}]
    drive(experiments.plan(design(arms=arms, factors=None)), store, Inline())
    renamed = [{**arms[0], "name": "fewer"}, arms[1]]
    engine = Inline()
    drive(experiments.plan(design(arms=renamed, factors=None)), store, engine)
    assert engine.done == []
    assert list(experiments.load(store.folder)["arm"].unique()) == ["fewer", "many"]


def test_rows_of_another_version_may_have_other_columns(design, store):
    plan = experiments.plan(design(factors=None))
    drive(plan, store, Inline())
    job = plan.job(plan.arms[0], 3)
    outcome = work(job)
    assert outcome.footprint is not None
    store.add(job, Outcome(outcome.footprint.assign(new_column=1.0)), {"code": ""})
    frame = experiments.load(store.folder)
    assert np.isnan(frame["new_column"].iloc[0]) and frame["new_column"].iloc[2] == 1.0


def test_rows_with_another_type_are_one_clear_line(design, store):
    plan = experiments.plan(design())
    drive(plan, store, Inline())
    (file, *_) = sorted((store.folder / "runs").glob("*.parquet"))
    frame = pd.read_parquet(file)
    frame.assign(units_per_h="many").to_parquet(file)
    with pytest.raises(InputError, match=r"are incompatible .*units_per_h.*run the experiment"):
        store.rows()


def test_nothing_is_there_before_the_first_run(design, store):
    plan = experiments.plan(design())
    assert store.rows().empty and store.finished() == set()
    assert progress_of(plan, store).finished == 0
    plan.save(store.folder)
    assert isinstance(experiments.load(store.folder), pd.DataFrame)
    with pytest.raises(InputError, match="contains no experiment"):
        experiments.load(store.folder / "elsewhere")


@pytest.mark.parametrize("broken", [b"", b"PAR1 and no more", None])
def test_a_corrupted_file_of_results_is_one_clear_line(design, store, capsys, broken):
    """Of runs, of a kept table: which file, and what to do about it."""
    path = design(keep=["series"])
    drive(experiments.plan(path), store, Inline())
    (run, *_) = sorted((store.folder / "series").glob("*.parquet"))
    whole = run.read_bytes()
    for file in (run, store.folder / "runs" / run.name):
        if broken is None:
            pd.DataFrame({"other": [1.0]}).to_parquet(file)
        else:
            file.write_bytes(broken)
        with pytest.raises(InputError, match=f"{file}: corrupted .*; remove it and run"):
            experiments.load(store.folder, table="series")
        file.write_bytes(whole)
        if file == run:
            assert len(experiments.load(store.folder, table="series")) == 48
        else:
            file.unlink()
    assert main(["experiment", "status", str(path), "--out", str(store.folder)]) == 0
    assert "11 of 12 runs finished" in capsys.readouterr().out


@pytest.mark.parametrize("column", ["run", "arm_digest", "replication", "seed"])
def test_a_row_that_does_not_say_whose_it_is_is_one_clear_line(design, store, column):
    drive(experiments.plan(design()), store, Inline())
    (file, *_) = sorted((store.folder / "runs").glob("*.parquet"))
    frame = pd.read_parquet(file)
    for nothing in (None, float("nan")):
        frame.assign(**{column: [nothing] * len(frame)}).to_parquet(file)
        with pytest.raises(InputError, match=f"{file}: corrupted .{column} is empty"):
            experiments.load(store.folder)
    if column != "run":
        frame.drop(columns=column).to_parquet(file)
        with pytest.raises(InputError, match=f"{file}: corrupted .{column} is empty"):
            experiments.load(store.folder)


@pytest.mark.parametrize("broken", ["", "{", "[]", '{"arm": "a"}'])
def test_a_corrupted_failure_is_one_clear_line(design, store, capsys, broken):
    path = design()
    drive(experiments.plan(path), store, Inline(do=work_that_fails_for_random))
    (failure, *_) = sorted((store.folder / "failures").glob("*.json"))
    failure.write_text(broken)
    assert main(["experiment", "status", str(path), "--out", str(store.folder)]) == 2
    told = capsys.readouterr().err
    assert str(failure) in told.replace("\n", "") and "corrupted" in told
    assert "Traceback" not in told
    failure.unlink()
    drive(experiments.plan(path), store, Inline())
    assert len(experiments.load(store.folder)) == 12


def test_a_corrupted_plan_is_one_clear_line(design, store):
    drive(experiments.plan(design()), store, Inline())
    told = json.loads((store.folder / "plan.json").read_text())
    for key in ("arms", "files", "design"):
        less = {name: value for name, value in told.items() if name != key}
        (store.folder / "plan.json").write_text(json.dumps(less))
        with pytest.raises(InputError, match=r"plan\.json: corrupted"):
            experiments.load(store.folder)


@pytest.mark.parametrize(
    "spoilt",
    [
        {"inputs": {"layout": {"layout": "small"}, "scenario": "basic", "controllers": "default"}},
        {"inputs": {"scenario": "basic", "controllers": "default"}},
        {"inputs": "basic"},
        {"name": 3},
        {"digest": None},
        {"overrides": [[[{}], 1]]},
        {"levels": {"controllers.psa": ["nearest"]}},
        {"levels": []},
    ],
)
def test_an_arm_that_is_none_is_one_clear_line(design, store, spoilt):
    drive(experiments.plan(design()), store, Inline())
    told = json.loads((store.folder / "plan.json").read_text())
    told["arms"][0] |= spoilt
    (store.folder / "plan.json").write_text(json.dumps(told))
    with pytest.raises(InputError, match=r"plan\.json: corrupted"):
        experiments.load(store.folder)
