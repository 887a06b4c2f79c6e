"""`rmfs decisions` on the command line: output, files, and one line for what is wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from decision_samples import sample

from rmfs.cli import main
from rmfs.solvers.decisions.files import write
from rmfs.solvers.decisions.schema import SCHEMAS, described


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with two questions of each of two families; it is the working directory."""
    for family in ("matching", "sequencing"):
        for seed in range(2):
            write(sample(family, seed), tmp_path / "questions")
    monkeypatch.chdir(tmp_path)
    return tmp_path / "questions"


def complaint(capsys: pytest.CaptureFixture[str]) -> str:
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1, lines
    return lines[0]


def test_a_run_writes_questions_that_are_solved_and_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    given = ["--layout", "small", "--scenario", "small", "--controllers", "pile-on"]
    given += ["--set", "scenario.duration_s=60", "--out", "run", "--decisions", "questions"]
    assert main(["run", *given]) == 0
    assert "questions written to questions" in capsys.readouterr().err
    assert main(["decisions", "solve", "questions", "--out", "answers"]) == 0
    for question in Path("questions").glob("*.json.gz"):
        answer = f"answers/{question.name.removesuffix('.json.gz')}.solution.json"
        assert main(["decisions", "check", str(question), answer]) == 0
    assert "allowed, value" in capsys.readouterr().out


def test_methods_limits_and_seeds_can_be_chosen(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (one, *_) = sorted(folder.glob("sequencing*"))
    assert main(["decisions", "solve", str(one), "--method", "dynamic", "--seed", "3"]) == 0
    assert "dynamic, optimal" in capsys.readouterr().out
    assert main(["decisions", "solve", str(one), "--method", "simplex"]) == 2
    assert "method simplex: not one of sequencing; valid: cp_sat, dynamic" in complaint(capsys)
    assert main(["decisions", "solve", "nowhere.json"]) == 2
    assert "nowhere.json: no such file" in complaint(capsys)


def spoil_value(raw: dict[str, Any]) -> None:
    raw["objective"] += 1


def spoil_robot(raw: dict[str, Any]) -> None:
    raw["values"]["robot"][0] = 3


@pytest.mark.parametrize(
    ("spoil", "told"), [(spoil_value, "is stated"), (spoil_robot, "3 is not within -1 and 2")]
)
def test_a_wrong_solution_ends_in_one_line_and_code_2(
    spoil: Any, told: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (one, *_) = sorted(folder.glob("matching*"))
    assert main(["decisions", "solve", str(one), "--out", "a"]) == 0
    capsys.readouterr()
    (answer,) = Path("a").iterdir()
    raw = json.loads(answer.read_text())
    spoil(raw)
    answer.write_text(json.dumps(raw))
    assert main(["decisions", "check", str(one), str(answer)]) == 2
    assert told in complaint(capsys)


@pytest.mark.parametrize("family", SCHEMAS)
def test_the_documented_fields_are_those_of_the_format(family: str) -> None:
    page = Path(__file__).parents[3] / "docs" / "decision-format.md"
    assert described(family) in page.read_text("utf-8")
