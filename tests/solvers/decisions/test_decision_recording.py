"""Questions written in a run: solved from their files they give the recorded answers."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite, isnan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rmfs
from rmfs.errors import InputError
from rmfs.experiments.design import plan
from rmfs.experiments.running.execute import execute
from rmfs.solvers.decisions.asking import asked_again
from rmfs.solvers.decisions.checking import check
from rmfs.solvers.decisions.files import Decision, read
from rmfs.solvers.decisions.recording import DecisionRecorder
from tests.tools.round_trip import (
    DERIVED,
    SETS,
    SMALLER,
    Count,
    asked,
    compare,
    recorded,
    unasked,
)


def same(one: Any, other: Any) -> bool:
    return bool(np.all(one == other)) if isinstance(one, np.ndarray) else bool(one == other)


def assert_answers_come_again(questions: list[Decision], family: str) -> None:
    assert family in {question.family for question in questions}
    for question in questions:
        kept = question.recorded
        assert kept is not None
        again = asked_again(question)
        assert again.objective == kept.objective
        assert again.bound == kept.bound if isfinite(again.bound) else isnan(kept.bound)
        assert again.by["work"] == kept.by["work"]
        if kept.values is None:
            assert again.values is None
            continue
        assert again.values is not None
        assert all(same(again.values[name], value) for name, value in kept.values.items())
        check(question, kept)


@pytest.mark.parametrize("controllers", SETS)
def test_recorded_questions_give_the_recorded_answers(controllers: str, tmp_path: Path) -> None:
    seconds = {"psa-prices": 400, "stocking": 20}.get(controllers, 60)
    questions = recorded(controllers, seconds, tmp_path)
    told = questions[0].provenance
    assert told["controllers"] == controllers
    assert set(told) >= {"rmfs", "seed", "time_s", "problem", "controller", "state", "number"}
    assert_answers_come_again(questions[:25], SETS[controllers])


@pytest.mark.slow
@pytest.mark.parametrize("name", [*SETS, *DERIVED])
def test_five_hundred_recorded_questions_of_each(name: str) -> None:
    count = (asked if name in SETS else unasked)(name, 500)
    assert count.questions == count.same == 500


@pytest.mark.parametrize("family", DERIVED)
def test_questions_that_nobody_asks_are_answered_alike(family: str) -> None:
    count = unasked(family, 5)
    assert count.questions == count.same == 5


def test_another_answer_is_counted(tmp_path: Path) -> None:
    question = recorded("ta-matching", 30.0, tmp_path)[0]
    assert question.recorded is not None
    count = Count("ta-matching", "matching")
    compare(count, question, asked_again)
    worse = replace(question.recorded, objective=question.recorded.objective + 1.0)
    compare(count, question, lambda one: worse)
    assert (count.questions, count.same, count.wrong) == (2, 1, (question.name,))


def test_recording_changes_nothing(tmp_path: Path) -> None:
    given = SMALLER | {"scenario.duration_s": 120.0}
    plain = rmfs.simulate(controllers="pile-on", set=given)
    keeper = DecisionRecorder(tmp_path, {})
    kept = rmfs.simulate(controllers="pile-on", set=given, observers=[keeper])
    column = "distance_per_unit_m"
    assert plain.footprint[column] == kept.footprint[column]
    assert plain.footprint["optimiser_calls"] == kept.footprint["optimiser_calls"] > 0


def test_questions_whose_answers_come_too_late_are_written_at_the_end(tmp_path: Path) -> None:
    questions = recorded("pile-on", 60.0, tmp_path, pacing="fixed=1000")
    assert [one.provenance["applied"] for one in questions] == [0] * len(questions)
    assert_answers_come_again(questions, "pile_on")


@pytest.mark.parametrize(
    ("way", "told"),
    [
        ({"by": "oracle"}, "asked.by: must be one of pile-on, planning"),
        ({"by": "planning", "speed": 3}, "asked: "),
        ({"by": "planning", "limits": {"seconds": 3}}, "asked: "),
        ({}, "asked.by: must be one of"),
    ],
)
def test_wrong_ways_of_asking_are_refused(way: dict[str, Any], told: str, tmp_path: Path) -> None:
    question = recorded("planning", 30.0, tmp_path)[0]
    with pytest.raises(InputError, match=told):
        asked_again(Decision(question.family, question.data, asked=way))


DESIGN = """
format = "rmfs-design/1"
name = "questions"
seeds = [1]
decisions = "kept"
[base]
layout = "small"
scenario = "small"
controllers = "pile-on"
"scenario.duration_s" = 60
[factors]
"controllers.poa.method" = ["joint", "greedy"]
"""


def test_a_design_keeps_the_questions_of_each_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("design.toml").write_text(DESIGN)
    made = plan(Path("design.toml"))
    made.require_sound()
    for arm in made.arms:
        assert execute(made.job(arm, 1)).error == ""
    folders = sorted(Path("kept").iterdir())
    assert len(folders) == 2
    for folder, method in zip(folders, ("greedy", "joint"), strict=True):
        questions = [read(path) for path in folder.iterdir()]
        assert {one.asked["method"] for one in questions} == {method}
        assert {one.provenance["design"] for one in questions} == {"questions"}
