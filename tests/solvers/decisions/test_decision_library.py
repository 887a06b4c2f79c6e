"""The library: drawn by its procedure, and made better only by what is checked."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from decision_samples import sample

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.solvers.decisions.checking import WrongError, check
from rmfs.solvers.decisions.files import Decision, read, write, write_solution
from rmfs.solvers.decisions.library import drawing
from rmfs.solvers.decisions.library.derived import derived
from rmfs.solvers.decisions.library.improving import METHODS, Effort, improve
from rmfs.solvers.decisions.library.table import Library, Row
from rmfs.solvers.decisions.schema import SCHEMAS
from rmfs.solvers.decisions.solving import methods, solve
from rmfs.solvers.models.families import family as model

TRACKED = Path(__file__).parents[3] / "instances" / "decisions"


@pytest.fixture
def library(tmp_path: Path) -> Library:
    """Two small questions of each of three families."""
    for family in ("matching", "pile_on", "sequencing"):
        for seed in range(2):
            write(sample(family, seed), tmp_path / family / "small")
    return Library.load(tmp_path)


def test_improving_proves_small_questions(library: Library) -> None:
    improve(library, Effort(work=0.5), tell=lambda line: None)
    again = Library.load(library.folder)
    assert {row.status for row in again.rows.values()} == {"optimal"}
    frame = pd.read_csv(library.folder / "best.csv")
    assert frame["gap"].max() < 1e-4
    for row in again.rows.values():
        question = read(again.path(row))
        answer = again.answer(row, question)
        assert answer is not None
        assert check(question, answer) == row.value
        assert row.value_by and row.value_when and row.bound_by and row.bound_when
    assert improve(again, Effort(work=0.5), tell=lambda line: None) == 0


def test_only_what_is_allowed_and_better_is_entered(library: Library) -> None:
    question = sample("matching", 0)
    best, rule = solve(question), solve(question, "greedy")
    assert library.enter(question, rule, "a rule") == ["value"]
    assert library.enter(question, best, "somebody") == (
        ["value"] if best.objective < rule.objective else []
    )
    assert library.enter(question, rule, "a rule") == []
    before = library.rows[question.name]
    with pytest.raises(WrongError, match="but the values give"):
        library.enter(question, replace(best, objective=best.objective - 5), "a liar")
    with pytest.raises(InputError, match=r"bound .* contradicts value"):
        library.enter(question, None, "a liar", bound=best.objective + 1)
    with pytest.raises(InputError, match="is not in"):
        library.enter(sample("matching", 9), best, "somebody")
    assert library.rows[question.name] == before
    assert library.enter(question, None, "assignment", bound=best.bound) == ["bound"]
    assert library.rows[question.name].status == "optimal"


def test_a_bound_that_contradicts_its_answer_leaves_everything_as_it_was(library: Library) -> None:
    """The table and the file of the best known answer belong together."""
    question = sample("matching", 0)
    best = solve(question)
    with pytest.raises(InputError, match=r"bound .* contradicts value"):
        library.enter(question, best, "a liar", bound=best.objective + 1)
    row = Library.load(library.folder).rows[question.name]
    assert math.isnan(row.value)
    assert library.answer(row, question) is None


def test_improving_goes_on_if_a_method_refuses_a_question(tmp_path: Path) -> None:
    """CP-SAT refuses a cost of 1e19; HiGHS finds 2 + 1 + 5, as zone 0 has one place."""
    cost_s = np.array([[1.0, 2.0], [1.0, 4.0], [1e19, 5.0]])
    data = {"begin_s": np.zeros(3), "end_s": np.ones(3), "cost_s": cost_s}
    question = Decision("stays", {**data, "capacity": np.array([1, 2])})
    write(question, tmp_path / "stays" / "small")
    told: list[str] = []
    improve(Library.load(tmp_path), Effort(work=0.1), tell=told.append)
    assert Library.load(tmp_path).rows[question.name].value == 8.0
    assert any("cp_sat" in line and "adds up to" in line for line in told)


def test_two_who_enter_at_a_time_lose_nothing(library: Library) -> None:
    """Each has read the table before the other wrote it."""
    other = Library.load(library.folder)
    one, two = sample("matching", 0), sample("matching", 1)
    assert library.enter(one, solve(one), "first") == ["value"]
    assert other.enter(two, solve(two), "second") == ["value"]
    again = Library.load(library.folder)
    assert again.rows[one.name].value_by == "first"
    assert again.rows[two.name].value_by == "second"
    # and what somebody has found meanwhile is not replaced by what is no better
    assert other.enter(one, solve(one), "second") == []


def test_gap_and_status_of_a_row() -> None:
    row = Row("q", "matching", "small", value=10.0, bound=9.0)
    assert (row.gap, row.status) == (0.1, "open")
    assert replace(row, bound=10.0 - 1e-9).status == "optimal"
    assert math.isnan(replace(row, bound=math.nan).gap)
    assert replace(row, bound=math.nan).status == "open"


def test_solutions_of_strangers_are_entered(
    library: Library, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, question = str(library.folder), sample("pile_on", 1)
    write_solution(question, solve(question, "cp_sat"), library.folder / "mine.solution.json")
    mine = str(library.folder / "mine.solution.json")
    given = ["decisions", "enter", mine, "--library", folder, "--by", "A. Stranger"]
    assert main(given) == 0
    assert "entered: best value" in capsys.readouterr().out
    assert Library.load(library.folder).rows[question.name].value_by == "A. Stranger"
    assert main(given) == 0
    assert "feasible, but no better" in capsys.readouterr().out
    wrong = replace(solve(question), objective=-1e6)
    write_solution(question, wrong, Path(mine))
    assert main(given) == 2
    write_solution(sample("pile_on", 7), solve(sample("pile_on", 7)), Path(mine))
    assert main(given) == 2
    assert "is not in" in capsys.readouterr().err
    assert main(["decisions", "improve", "--library", folder, "--family", "pileon"]) == 2
    assert "--family pileon: must be one of pile_on" in capsys.readouterr().err


def test_a_draw_takes_one_question_of_each_third(monkeypatch: pytest.MonkeyPatch) -> None:
    """And repeats."""
    site = replace(drawing.SITES["small"], duration_s=90.0, seeds=(1,))
    monkeypatch.setattr(drawing, "SITES", {"small": site})
    drawn = list(drawing.draw("balance", "small"))
    told = [(one.provenance["drawn"]["load"], one.provenance["drawn"]["moment"]) for one in drawn]
    assert told == [(load, moment) for load in drawing.LOADS for moment in drawing.MOMENTS]
    for third, one in enumerate(drawn[:3]):
        assert 30.0 * third <= one.provenance["time_s"] < 30.0 * (third + 1)
        assert one.recorded is not None
    assert [one.hash for one in drawing.draw("balance", "small")] == [one.hash for one in drawn]


def test_questions_that_nobody_asks_are_made_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = [sample("pile_on", seed) for seed in range(3)]
    for family in ("rack_allocation", "sequencing"):
        made = list(derived(family, "small", asked))
        assert [one.provenance["made_of"] for one in made] == [one.name for one in asked]
        assert family == "rack_allocation" or all(solve(one).is_there for one in made)
    (one, *_) = derived("run_bound", "small", ())
    assert one.data["robots"] == 2
    assert solve(one).objective > 0


def test_searches_name_methods_that_are_there() -> None:
    assert set(METHODS) == set(SCHEMAS)
    for family, named in METHODS.items():
        assert set(named) <= set(methods(family))
        assert model(family).solve.default in (*named, "highs")
