"""What is done from Python at the first hour, as the documentation has it."""

from __future__ import annotations

import functools
import multiprocessing
import os
import pickle
import re
from pathlib import Path

import pytest

import rmfs
from rmfs.control.poa.order_rules import FirstCome
from rmfs.errors import InputError
from rmfs.measure.dictionary import TABLES
from rmfs.measure.results import Results

PAGE = Path(__file__).parents[2] / "docs" / "python.md"
SHORT = {"layout.robots": 8, "scenario.warmup_s": 0, "scenario.duration_s": 300}


@pytest.fixture(scope="module")
def run() -> rmfs.Run:
    return rmfs.simulate(set=SHORT, seed=1, trace=True)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    return tmp_path


@pytest.mark.slow
def test_the_page_works_as_it_is_written(here: Path) -> None:
    known: dict[str, object] = {}
    for cell in re.findall(r"```{code-cell} ipython3\n(.*?)```", PAGE.read_text(), re.DOTALL):
        exec(cell, known)
    run, study = known["run"], known["study"]
    assert isinstance(run, rmfs.Run) and isinstance(study, rmfs.Study)
    assert len(repr(run).splitlines()) < 20
    assert len(study.frame) == 40


def test_a_study_of_a_few_runs(here: Path) -> None:
    Path("quick_rule.py").write_text(
        "from rmfs.control.poa.order_rules import FirstCome\nclass Quick(FirstCome):\n    pass\n"
    )
    from quick_rule import Quick  # type: ignore[import-not-found]

    factors = {"layout.robots": [4, 8], "controllers.poa.name": ["pod-match", Quick]}
    base = {"scenario.warmup_s": 0, "scenario.duration_s": 120}
    study = rmfs.experiment(factors, seeds=range(2), base=base, processes=2)
    assert len(study.frame) == 8
    assert set(study.frame["controllers.poa.name"]) == {"pod-match", "Quick"}
    told = study.table("units_per_h", by="layout.robots").frame
    means = study.frame.groupby("layout.robots")["units_per_h"].mean()
    assert told["units_per_h", "mean"].tolist() == pytest.approx(means.tolist())
    assert told["seeds", ""].tolist() == [2, 2]
    pairs = study.compare("units_per_h", by="controllers.poa.name").frame
    rates = study.frame.groupby("controllers.poa.name")["units_per_h"].mean()
    assert pairs["units_per_h", "difference"].iloc[0] == pytest.approx(
        rates["Quick"] - rates["pod-match"]
    )
    assert study.plot("units_per_h")._repr_png_().startswith(b"\x89PNG")
    for kind in ("intervals", "effects", "interaction", "pareto"):
        assert study.plot(kind=kind)._repr_png_().startswith(b"\x89PNG")
    assert len(study.plot("units_per_h", "distance_m", by="layout.robots").axes) == 2
    assert "4 arms, 8 runs" in repr(study) and "<table" in study._repr_html_()
    again = rmfs.experiment(factors, seeds=range(2), base=base, processes=2)
    assert again.folder == study.folder and again.frame.equals(study.frame)
    for wrong, message in (
        (lambda: study.table("units"), "units: no such column"),
        (lambda: study.table(by="robots"), "no such factor; factors: layout.robots"),
        (lambda: study.compare(baseline="x"), "baseline x: valid: "),
        (lambda: study.plot(kind="bars"), "kind bars: no such plot; valid: intervals, effects"),
        (lambda: study.plot(kind="pareto", by="layout.robots"), "by layout.robots: for intervals"),
    ):
        with pytest.raises(InputError, match=message):
            wrong()
    with pytest.raises(InputError, match=r"poa=nonsense.*no poa rule named"):
        rmfs.experiment({"controllers.poa.name": ["nonsense"]})


def test_defaults_and_set_are_what_was_said_before(run: rmfs.Run) -> None:
    pairs = [(key.split("."), value) for key, value in SHORT.items()]
    same = rmfs.simulate("default", "default", "default", seed=1, overrides=pairs)
    measured = [column.name for column in TABLES["footprint"] if column.measured]
    assert same.footprint.drop(measured).equals(run.footprint.drop(measured))
    assert rmfs.__version__[0].isdigit()


def test_a_class_stands_where_a_name_does() -> None:
    class Own(FirstCome):
        asked = 0

        def decide(self):
            type(self).asked += 1
            return super().decide()

    brief = SHORT | {"scenario.duration_s": 60}
    named = rmfs.simulate(set={**brief, "controllers.poa": "first-come"})
    for key, value in (("controllers.poa.name", Own), ("controllers.poa", {"name": Own})):
        given = rmfs.simulate(set={**brief, key: value})
        assert given.footprint["units_picked"] == named.footprint["units_picked"]
    assert Own.asked > 0
    with pytest.raises(InputError, match="set: must be a mapping of keys to values"):
        rmfs.simulate(set=["layout.robots=8"])  # type: ignore[arg-type]


def test_a_run_shows_itself(run: rmfs.Run) -> None:
    lines = repr(run).splitlines()
    assert lines[0] == "default / default / default, seed 1" and len(lines) < 20
    assert f"{run.footprint['units_picked']:,}" in repr(run)
    assert "<table>" in run._repr_html_()
    from rich.console import Console

    console = Console(record=True, file=open(os.devnull, "w"), width=100)  # noqa: SIM115, PTH123
    console.print(run)
    assert "units per hour" in console.export_text()


def test_a_run_and_its_folder_are_used_alike(run: rmfs.Run, here: Path) -> None:
    saved = run.save("results/mine")
    assert isinstance(run, Results) and isinstance(saved, Results)
    for name in TABLES:
        assert saved.table(name).equals(run.table(name)), name
    assert saved.check().ok and run.check().ok
    assert run.footprint["collisions"] == 0
    assert repr(saved).splitlines()[:5] == repr(run).splitlines()[:5]
    for one in (run, saved):
        assert one.plot("throughput")._repr_png_().startswith(b"\x89PNG")
        assert one.view("page.html", open_browser=False).size_mb > 0.01
    with pytest.raises(InputError, match="a run folder of this name exists already"):
        run.save("results/mine")
    assert saved.save("results/copy").footprint.equals(saved.footprint)
    with pytest.raises(InputError, match="no such table; valid: footprint, "):
        run.table("nonsense")


def test_without_a_trace_that_is_said(here: Path) -> None:
    blind = rmfs.simulate(set=SHORT | {"scenario.duration_s": 60})
    for ask in (blind.check, blind.view):
        with pytest.raises(InputError, match="simulate it with trace=True"):
            ask()


def test_a_run_travels(run: rmfs.Run, here: Path) -> None:
    twin = pickle.loads(pickle.dumps(run))
    assert repr(twin) == repr(run) and twin.check().ok
    for name in TABLES:
        assert twin.table(name).equals(run.table(name)), name
    saved = twin.save("results/twin")
    assert saved.check().ok and saved.table("answers").equals(run.table("answers"))
    with pytest.raises(AttributeError, match="world is not available"):
        _ = twin.world
    again = pickle.loads(pickle.dumps(twin))
    assert again.footprint.equals(run.footprint)


def test_runs_of_a_pool(here: Path) -> None:
    work = functools.partial(rmfs.simulate, set=SHORT | {"scenario.duration_s": 60})
    with multiprocessing.get_context("forkserver").Pool(1) as pool:
        (told,) = pool.map(work, ["default"])
    assert told.footprint["units_picked"] == work("default").footprint["units_picked"]
