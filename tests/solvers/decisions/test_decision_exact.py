"""Programmes written for any solver: HiGHS finds the optimum of enumeration in them."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterator
from pathlib import Path

import highspy
import numpy as np
import pytest
from decision_samples import sample

from rmfs.errors import InputError
from rmfs.solvers.decisions.checking import WrongError, check
from rmfs.solvers.decisions.exact import Exact, exact
from rmfs.solvers.decisions.exact.reading import answer_of
from rmfs.solvers.decisions.exact.writing import write_map, write_program
from rmfs.solvers.decisions.files import Decision, Found
from rmfs.solvers.decisions.schema import SCHEMAS, Plain
from rmfs.solvers.decisions.solving import solve

EXACT = {
    "pile_on": "cp_sat",
    "planning": "cp_sat",
    "sequencing": "dynamic",
    "rack_allocation": "cp_sat",
    "placement": "assignment",
    "stays": "cp_sat",
    "zones": "clarabel",
    "charging": "highs",
    "matching": "assignment",
    "balance": "flow",
    "sequence": "cp_sat",
    "replenishment": "cp_sat",
    "run_bound": "highs",
}


def by_highs(program: Path, solution: Path) -> float:
    """Let HiGHS read a file and write its solution; return the objective, inf for infeasible."""
    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("mip_rel_gap", 0.0)
    assert solver.readModel(str(program)) == highspy.HighsStatus.kOk
    solver.run()
    if solver.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return math.inf
    solver.writeSolution(str(solution), 0)
    return float(solver.getInfo().objective_function_value)


@pytest.mark.parametrize("ending", ["mps", "lp"])
@pytest.mark.parametrize("family", SCHEMAS)
def test_any_solver_finds_the_optimum_in_the_file(family: str, ending: str, tmp_path: Path) -> None:
    for seed in range(6):
        question = sample(family, seed)
        stated = exact(question)
        write_program(stated, tmp_path / f"q.{ending}")
        value = by_highs(tmp_path / f"q.{ending}", tmp_path / "q.sol") * stated.factor
        best = solve(question, EXACT[family])
        if best.values is None:
            assert math.isinf(value)
            continue
        assert value == pytest.approx(best.objective, rel=1e-6, abs=1e-6), seed
        found = answer_of(question, stated, tmp_path / "q.sol", {"backend": "highs"})
        assert found.objective == pytest.approx(best.objective, rel=1e-6, abs=1e-6), seed


def rows(*columns: tuple[int, int, int]) -> Iterator[list[np.ndarray]]:
    """Go through all arrays of whole numbers: length, least and last of each array."""
    for chosen in itertools.product(
        *(itertools.product(range(low, end), repeat=length) for length, low, end in columns)
    ):
        yield [np.array(one, np.int64) for one in chosen]


def everything(question: Decision) -> Iterator[Plain]:
    """Go through all answers that could be allowed."""
    names = [field.name for field in question.schema.values]
    n = question.sizes
    match question.family:
        case "placement":
            spans = [(n["P"], 0, n["L"])]
        case "stays":
            spans = [(n["N"], 0, n["Z"])]
        case "charging":
            spans = [(n["R"], -1, n["G"]), (n["R"], 0, n["T"]), (n["R"], 0, 4)]
        case "matching" | "balance":
            spans = [(n["T"], -1, n["R"])]
        case "replenishment":
            spans = [(n["B"], -1, n["P"]), (n["P"], -1, n["S"])]
        case "rack_allocation":
            spans = [(n["O"], -1, n["S"]), (n["P"], -1, n["S"])]
        case "sequencing":
            for length in range(1, 4):
                for pods, start in rows((length, 0, n["P"]), (n["O"], 0, length)):
                    yield {"pods": pods, "start": start}
            return
        case "sequence":
            yield from routes(n)
            return
    for arrays in rows(*spans):
        yield dict(zip(names, arrays, strict=True))


def routes(n: dict[str, int]) -> Iterator[Plain]:
    for of in itertools.product(range(-1, n["R"]), repeat=n["T"]):
        for order in itertools.permutations(range(n["T"])):
            tasks = [[t for t in order if of[t] == r] for r in range(n["R"])]
            for place, first in rows((n["T"], -1, n["L"]), (n["R"], -1, n["L"])):
                yield {"tasks": tasks, "place": place, "robot_place": first}


ENUMERATED = ["placement", "stays", "matching", "balance", "replenishment", "sequencing"]


@pytest.mark.parametrize("family", [*ENUMERATED, "sequence", "rack_allocation", "charging"])
def test_the_optimum_is_that_of_enumeration(family: str, tmp_path: Path) -> None:
    """The checks go through everything; HiGHS finds the best of it."""
    for seed in range(2):
        question = sample(family, seed)
        best = math.inf
        for values in everything(question):
            try:
                best = min(best, check(question, Found(values)))
            except WrongError:
                continue
        stated = exact(question)
        write_program(stated, tmp_path / "q.mps")
        value = by_highs(tmp_path / "q.mps", tmp_path / "q.sol")
        assert value == pytest.approx(best, rel=1e-6, abs=1e-6)


def test_numbers_in_the_file_are_the_same_doubles(tmp_path: Path) -> None:
    question = sample("placement", 1)
    stated = exact(question)
    write_program(stated, tmp_path / "q.mps")
    costs = {}
    for line in (tmp_path / "q.mps").read_text().splitlines():
        words = line.split()
        if len(words) == 3 and words[1] == "cost":
            costs[words[0]] = float(words[2])
    expected = dict(zip(stated.names.name, stated.program.cost.tolist(), strict=True))
    assert {name: cost for name, cost in costs.items() if name != "one"} == expected


def test_every_column_has_a_name_of_its_own_and_the_map_says_what_it_decides(
    tmp_path: Path,
) -> None:
    for family in SCHEMAS:
        question = sample(family, 2)
        stated: Exact = exact(question)
        assert len(set(stated.names.name)) == stated.program.columns
        assert not any(name.startswith("column_") for name in stated.names.name)
        write_map(question, stated, tmp_path / "q.map.json")
        told = json.loads((tmp_path / "q.map.json").read_text())
        assert told["question"] == question.hash
        assert list(told["columns"]) == stated.names.name
        assert any(told["columns"].values())


SOLUTIONS = {
    "plain": "send_r0_t1 1\nsend_r1_t0 1\nleave_t2 1\nleave_t3 1\n",
    "scip": "solution status: optimal\nobjective value:  3\nsend_r0_t1   1   (obj:2)\n"
    "send_r1_t0 1 (obj:3)\nleave_t2 1 (obj:1)\nleave_t3 0.9999999 (obj:1)\n",
    "cbc": "Optimal - objective value 3\n  1 send_r0_t1  1  2\n  3 send_r1_t0  1  3\n"
    "  8 leave_t2 1 0\n  9 leave_t3 1 0\n",
    "cplex": '<CPLEXSolution><variables><variable name="send_r0_t1" index="1" value="1"/>'
    '<variable name="send_r1_t0" index="4" value="1"/><variable name="leave_t2" value="1"/>'
    '<variable name="leave_t3" value="1"/></variables></CPLEXSolution>',
    # as GLPK 5.0 prints, with one of the names made longer than its column
    "glpk": "Status:     INTEGER OPTIMAL\nObjective:  cost = 25 (MINimum)\n\n"
    "   No.   Row name        Activity     Lower bound   Upper bound\n"
    "------ ------------    ------------- ------------- -------------\n"
    "     1 robot_0                     1             1             = \n\n"
    "   No. Column name       Activity     Lower bound   Upper bound\n"
    "------ ------------    ------------- ------------- -------------\n"
    "     1 send_r0_t0   *              0             0             1 \n"
    "     2 send_r0_t1\n                    *              1             0             1 \n"
    "     5 send_r1_t0   *              1             0             1 \n"
    "    11 leave_t2                    1             0             1 \n"
    "    12 leave_t3                    1             0             1 \n",
    "glpk relaxed": "   No. Column name  St   Activity     Lower bound   Upper bound    Marginal\n"
    "------ ------------ -- ------------- ------------- ------------- -------------\n"
    "     1 send_r0_t0   NL             0             0             1             2 \n"
    "     2 send_r0_t1   NU             1             0             1            -1 \n"
    "     5 send_r1_t0   B              1             0             1 \n"
    "    11 leave_t2\n                    B              1             0             1 \n"
    "    12 leave_t3     B              1             0             1 \n",
}


@pytest.mark.parametrize("kind", SOLUTIONS)
def test_solution_files_of_solvers_are_read(kind: str, tmp_path: Path) -> None:
    data = {"travel_s": np.array([[9.0, 2, 9, 9], [3, 9, 9, 9]]), "leave_s": np.full(4, 10.0)}
    question = Decision("matching", data)
    (tmp_path / "a.sol").write_text(SOLUTIONS[kind])
    found = answer_of(question, exact(question), tmp_path / "a.sol", {})
    assert found.values is not None
    assert found.values["robot"].tolist() == [1, 0, -1, -1]
    assert found.objective == 25.0


def test_solution_files_that_are_none_are_refused(tmp_path: Path) -> None:
    question = sample("matching", 0)
    (tmp_path / "a.sol").write_text("infeasible\n")
    with pytest.raises(InputError, match="names no column"):
        answer_of(question, exact(question), tmp_path / "a.sol", {})
    (tmp_path / "a.sol").write_text("send_r0_t0 1\nsend_r0_t1 1\n")
    with pytest.raises(InputError, match=r"robot: 0 occurs twice|is not allowed"):
        answer_of(question, exact(question), tmp_path / "a.sol", {})


@pytest.mark.parametrize("ending", ["mps", "lp"])
def test_a_row_without_columns_still_forbids(ending: str, tmp_path: Path) -> None:
    """A pod must be stored, and there is no place for it."""
    data = {"travel_s": np.zeros((1, 0)), "access_s": np.zeros(0), "visits": np.ones(1)}
    write_program(exact(Decision("placement", data)), tmp_path / f"q.{ending}")
    assert by_highs(tmp_path / f"q.{ending}", tmp_path / "q.sol") == math.inf


@pytest.mark.parametrize(
    ("family", "data"),
    [
        (
            "placement",
            {"travel_s": np.zeros((0, 0)), "access_s": np.zeros(0), "visits": np.zeros(0)},
        ),
        (
            "sequencing",
            {
                "needs": np.zeros((0, 1), int),
                "holds": np.ones((1, 1), int),
                "capacity": 1,
                "opened": np.zeros(0, int),
            },
        ),
    ],
)
def test_nothing_to_decide_is_a_program_with_an_answer(family: str, data: Plain) -> None:
    question = Decision(family, data)
    stated = exact(question)
    values = stated.answer(np.zeros(stated.program.columns))
    assert check(question, Found(values)) == 0.0
