"""`rmfs decisions` on the command line: output, files, and one line for what is wrong."""

from __future__ import annotations

import csv
import json
import shlex
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from decision_samples import sample

from rmfs.cli import main
from rmfs.solvers.decisions.bounding import bounds
from rmfs.solvers.decisions.files import Decision, write
from rmfs.solvers.decisions.schema import SCHEMAS, described
from rmfs.solvers.decisions.solving import solve


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
    assert "feasible, value" in capsys.readouterr().out


def test_methods_limits_and_seeds_can_be_chosen(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (one, *_) = sorted(folder.glob("sequencing*"))
    assert main(["decisions", "solve", str(one), "--method", "dynamic", "--seed", "3"]) == 0
    assert "dynamic, optimal" in capsys.readouterr().out
    assert main(["decisions", "solve", str(one), "--method", "simplex"]) == 2
    assert "method simplex: unknown for sequencing; valid: cp_sat, dynamic" in complaint(capsys)
    assert main(["decisions", "solve", "nowhere.json"]) == 2
    assert "nowhere.json: no such file" in complaint(capsys)
    for option in (["--seed", "0"], ["--work", "3"]):
        assert main(["decisions", "solve", str(one), "--method", "asked", *option]) == 2
        assert "takes no limit, seed or start" in complaint(capsys)


def spoil_value(raw: dict[str, Any]) -> None:
    raw["objective"] += 1


def spoil_robot(raw: dict[str, Any]) -> None:
    raw["values"]["robot"][0] = 3


@pytest.mark.parametrize(
    ("spoil", "told"),
    [(spoil_value, "but the values give"), (spoil_robot, "must be from -1 to 2, is 3")],
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


STAND_IN = """
import sys
import highspy
program, solution = sys.argv[1:]
solver = highspy.Highs()
solver.setOptionValue("output_flag", False)
solver.readModel(program)
solver.run()
values = solver.getSolution().col_value
names = [solver.getColName(i)[1] for i in range(len(values))]
with open(solution, "w") as file:
    for name, value in zip(names, values):
        print(name, value, file=file)
"""
"""A solver of somebody else: reads the MPS, writes names and values."""


def test_a_solver_of_somebody_else_is_a_command(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("stand_in.py").write_text(STAND_IN)
    script = Path("stand_in.py").resolve()
    command = f"{sys.executable} {script} {{program}} {{solution}}"
    assert main(["decisions", "solve", str(folder), "--with", command, "--out", "a"]) == 0
    for question in folder.iterdir():
        answer = f"a/{question.name.removesuffix('.json.gz')}.solution.json"
        assert main(["decisions", "check", str(question), answer]) == 0
        ours = json.loads(Path(answer).read_text())
        assert main(["decisions", "solve", str(question), "--with", "highs", "--out", "b"]) == 0
        theirs = json.loads(Path(answer.replace("a/", "b/")).read_text())
        assert ours["objective"] == pytest.approx(theirs["objective"])


def test_files_of_a_command_are_looked_for_in_the_working_folder(folder: Path) -> None:
    (one, *_) = sorted(folder.glob("matching*"))
    Path("own").mkdir()
    script = Path("own/stand_in.py")
    script.write_text(f"#!{sys.executable}\n{STAND_IN}")
    script.chmod(0o755)
    python = shlex.quote(sys.executable)
    for number, command in enumerate((f"{python} own/stand_in.py", "own/stand_in.py")):
        with_solver = ["--with", f"{command} {{program}} {{solution}}"]
        out = f"answer-{number}"
        assert main(["decisions", "solve", str(one), *with_solver, "--out", out]) == 0
        (answer,) = Path(out).iterdir()
        assert main(["decisions", "check", str(one), str(answer)]) == 0


FAILING = {
    "nobody": ("cp-optimizer", "must be one of highs, scip, gurobi, cplex, cbc, or a command"),
    "missing": ("no-such-solver {program} {solution}", "the program no-such-solver was not found"),
    "failing": ("false {program} {solution}", "ended with code 1"),
    "silent": ("true {program} {solution}", "wrote no solution"),
    "wrong": ("cp {program} {solution}", "matching-"),
    "quoted": ('solver "{program} {solution}', "No closing quotation"),
}


@pytest.mark.parametrize("kind", FAILING)
def test_solvers_that_fail_are_told_in_one_line(
    kind: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command, told = FAILING[kind]
    (one, *_) = sorted(folder.glob("matching*"))
    assert main(["decisions", "solve", str(one), "--with", command]) == 2
    assert told in complaint(capsys)


def test_programmes_are_written_and_solutions_read_back(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (one, *_) = sorted(folder.glob("matching*"))
    assert main(["decisions", "convert", str(one), "--to", "lp", "--out", "e"]) == 0
    stem = one.name.removesuffix(".json.gz")
    assert Path(f"e/{stem}.lp").is_file()
    assert Path(f"e/{stem}.map.json").is_file()
    Path("x.sol").write_text("".join(f"leave_t{t} 1\n" for t in range(4)))
    assert main(["decisions", "convert", str(one), "--solution", "x.sol", "--out", "e"]) == 0
    assert main(["decisions", "check", str(one), f"e/{stem}.solution.json"]) == 0
    assert main(["decisions", "convert", str(folder), "--solution", "x.sol"]) == 2
    assert "--solution: requires exactly one question" in capsys.readouterr().err


@pytest.mark.parametrize("family", SCHEMAS)
def test_bounds_are_below_what_is_found(family: str) -> None:
    for seed in range(3):
        question = sample(family, seed)
        found = solve(question)
        if found.values is None:
            continue
        proven = list(bounds(question, 0.1))
        assert proven
        slack = 1e-6 * max(1.0, abs(found.objective))
        assert all((value - found.objective) * question.sign <= slack for _, value in proven)


UNSOLVABLE: dict[str, dict[str, Any]] = {
    "matching": {"travel_s": np.ones((1, 2)), "leave_s": np.full(2, np.inf)},
    "rack_allocation": {
        "units": np.array([[3]]),
        "stock": np.array([[1]]),
        "slots": np.array([1]),
    },
    "zones": {
        "visit_s": np.ones((1, 1)),
        "rate_per_h": np.ones(1),
        "pods": np.array([3.0]),
        "places": np.ones(1),
        "congestion_s_h": np.zeros(1),
    },
}
"""Two tasks for one robot, three units of which there is one, three pods for one place."""


@pytest.mark.parametrize("family", UNSOLVABLE)
def test_the_bound_of_a_question_without_a_solution_is_infinite(
    family: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(Decision(family, UNSOLVABLE[family]), tmp_path)
    assert main(["decisions", "bound", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines()[-1].endswith(": bound inf")


def test_a_bound_is_printed_if_the_search_refuses_the_question(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The only choice costs 2 + 3; the costs of the other one add up to too much for CP-SAT."""
    cost_s = np.array([[1e19, 2.0], [3.0, 4e18]])
    data = {"begin_s": np.zeros(2), "end_s": np.ones(2), "cost_s": cost_s}
    write(Decision("stays", {**data, "capacity": np.ones(2, int)}), tmp_path)
    assert main(["decisions", "bound", str(tmp_path)]) == 0
    told = capsys.readouterr().out.splitlines()
    assert [line.split(": ")[1] for line in told[:-1]] == ["relaxation"]
    assert float(told[-1].split()[-1]) <= 5.0


def test_bounds_and_profiles_are_printed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["decisions", "bound", str(folder), "--work", "0.1"]) == 0
    assert "relaxation: " in capsys.readouterr().out
    assert main(["decisions", "profile", str(folder), "--work", "0.004", "--out", "p.csv"]) == 0
    out = capsys.readouterr().out
    assert "mean primal integrals" in out
    with Path("p.csv").open() as file:
        runs = Counter((row["method"], row["question"]) for row in csv.DictReader(file))
    once = {method for (method, _), count in runs.items() if count == 1}
    several = {method for (method, _), count in runs.items() if count > 1} - once
    assert once and several
    shown = {words[-3]: words[-1] for line in out.splitlines() if len(words := line.split()) > 2}
    # run once, the integral over work of a method would be 1, whatever it found
    assert all(shown[method] == "-" for method in once)
    assert all(0.0 <= float(shown[method]) <= 1.0 for method in several)
    assert "question,family,method,seed" in Path("p.csv").read_text()
