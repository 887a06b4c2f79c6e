"""The studies on the library of decisions, on a library of a few questions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from decision_samples import sample

from rmfs.experiments.papers import decision_library, decision_online, offline_online
from rmfs.experiments.papers.study import command
from rmfs.solvers.decisions.asking import question_of
from rmfs.solvers.decisions.files import Decision, write
from rmfs.solvers.decisions.library.improving import Effort, improve
from rmfs.solvers.decisions.library.table import Library
from rmfs.solvers.decisions.models import model_data
from rmfs.solvers.decisions.solving import solve


@pytest.fixture
def library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Small questions of two families, each with the answer of the rule as the recorded one."""
    from rmfs.solvers.control.storage.placement import Question

    monkeypatch.chdir(tmp_path)
    for seed in range(3):
        data = model_data(sample("placement", seed))
        asked = question_of(Question(data, "assignment", np.arange(5)))
        assert asked is not None
        recorded = solve(asked, "greedy")
        write(
            Decision("placement", asked.data, {}, asked.asked, recorded), Path("L/placement/small")
        )
        write(sample("stays", seed), Path("L/stays/small"))
    improve(Library.load(Path("L")), Effort(work=0.1), tell=lambda line: None)
    return Path("L")


def test_methods_are_timed_and_pages_made(library: Path) -> None:
    given = ["--library", str(library), "--published", "out"]
    timing = ["--time", "--size", "small", "--family", "stays", "--seeds", "2", "--questions", "2"]
    assert command(decision_library.main, [*given, *timing]) == 0
    rows = pd.read_csv("out/decision-times.csv")
    assert set(rows["method"]) == {"greedy", "cp_sat", "highs"}
    assert set(rows["seed"]) == {0, 1}
    text = Path("out/decision-library.md").read_text()
    assert "| placement | small |" in text.replace("  ", " ").replace("  ", " ")
    assert (Path("out") / "decision-performance.png.provenance.json").is_file()
    before = Path("out/decision-integrals.md").read_text()
    # from the published rows alone
    assert command(decision_library.main, given) == 0
    assert Path("out/decision-integrals.md").read_text() == before
    again = decision_library.online(Library.load(library))
    assert again["questions"].tolist() == [3]


def test_offline_gaps_are_those_of_the_arms_method(library: Path) -> None:
    known = Library.load(library)
    assert offline_online.offline_gaps(known, "placement assignment", "small") == pytest.approx(
        [0.0] * 3, abs=1e-12
    )
    greedy = offline_online.offline_gaps(known, "placement greedy", "small")
    assert len(greedy) == 3
    assert max(greedy) > 0.0


def test_offline_searches_take_the_steps_of_the_controller() -> None:
    """The controllers of the arms count steps per station or per task."""
    sizes = {"planning lns 10": ("planning", "S", 10), "sequence lns": ("sequence", "T", 200)}
    for arm, (family, size, steps) in sizes.items():
        _, changes = offline_online.ASKED[arm]
        assert callable(changes)
        decision = sample(family, 0)
        assert changes(decision)["limits"]["iterations"] == steps * decision.sizes[size]


def test_correlations_are_paired_by_seed() -> None:
    """A seed that lifts all arms alike says nothing of the methods."""
    arms = ["placement greedy", "placement assignment"]
    frame = pd.DataFrame(
        [
            {"solver": arm, "replication": seed, "units_per_h": 100.0 * seed + (arm == arms[1]),
             "late_share": 0.0, "distance_per_unit_m": 10.0 - 3.0 * (arm == arms[0])}
            for arm in arms for seed in (1, 2, 3)
        ]
    )  # fmt: skip
    table = offline_online.correlations(frame, {arms[0]: 0.2, arms[1]: 0.0})
    row = table.frame.iloc[0]
    assert row["units_per_h", "rank correlation"] == pytest.approx(-1.0)
    assert row["distance_per_unit_m", "rank correlation"] == pytest.approx(-1.0)
    assert np.isnan(row["late_share", "rank correlation"])


def test_the_study_is_run_and_published(library: Path, design) -> None:  # type: ignore[no-untyped-def]
    path = design(
        seeds=[1, 2],
        base={
            "layout": "small",
            "scenario": "small",
            "layout.robots": 3,
            "scenario.duration_s": 120,
            "scenario.warmup_s": 0,
        },
        factors={
            "solver": [
                {"label": "placement greedy", "controllers": "psa-placement",
                 "controllers.psa.method": "greedy"},
                {"label": "placement assignment", "controllers": "psa-placement"},
            ]
        },
    )  # fmt: skip
    given = ["--design", str(path), "--out", "runs", "--published", "out", "--jobs", "1"]
    assert command(offline_online.main, [*given, "--library", str(library)]) == 0
    rows = pd.read_csv("out/offline-online.csv", index_col=0)
    assert list(rows.index) == ["placement greedy", "placement assignment"]
    found = pd.read_csv("out/offline-online-correlations.csv", index_col=0)
    assert found.index.tolist() == ["placement"]


def test_every_arm_of_the_design_is_known() -> None:
    from rmfs.experiments.design import plan

    made = plan("offline-online")
    made.require_sound()
    assert {arm.levels["solver"] for arm in made.arms} == set(offline_online.ASKED)


def test_questions_are_asked_again_with_other_settings(tmp_path: Path) -> None:
    """Of two families: the gap to the best known value, and the steps that a setting asks for."""
    from rmfs.solvers.control.tasks.routes import Question
    from rmfs.solvers.models.solution import Limits

    data = model_data(sample("sequence", 1))
    asked = question_of(Question(data, "greedy", Limits(deterministic_s=0.01), 2, 2))
    assert asked is not None
    write(asked, tmp_path / "L" / "sequence" / "medium")
    library = Library.load(tmp_path / "L")
    improve(library, Effort(work=1.0), tell=lambda line: None)
    rows = pd.DataFrame(decision_online.answered(library, ("medium", "real")))
    assert set(rows["family"]) == {"sequence"}
    best = next(iter(library.rows.values()))
    greedy = solve(asked, "greedy")
    expected = abs(greedy.objective - best.value) / greedy.objective
    assert rows["gap"].tolist()[0] == pytest.approx(expected)
    assert rows["gap"].tolist()[1:] == pytest.approx([0.0] * 4, abs=1e-6)
    table = decision_online.compared(rows)
    assert table["questions"].tolist() == [1] * len(table)
    for name, steps in zip(decision_online.SETTINGS["planning"], (450, 675, 4500), strict=True):
        changed = decision_online.SETTINGS["planning"][name](_Stations(3))  # type: ignore[arg-type]
        assert changed["limits"]["iterations"] == steps


class _Stations:
    def __init__(self, number: int) -> None:
        self.sizes = {"S": number}
