"""Answers checked without the models: they agree with the models on right and wrong ones."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from decision_samples import sample

from rmfs.solvers.decisions.checking import WrongError, check
from rmfs.solvers.decisions.files import Decision, Found
from rmfs.solvers.decisions.models import model_data, model_values
from rmfs.solvers.decisions.schema import SCHEMAS
from rmfs.solvers.decisions.solving import methods, solve
from rmfs.solvers.models.families import family as model


def test_the_checks_know_no_models() -> None:
    """What verifies answers imports neither models nor controllers."""
    families = ", ".join(f"checking.{family}" for family in SCHEMAS)
    names = [
        f"rmfs.solvers.decisions.{one}" for one in ("checking", "files", *families.split(", "))
    ]
    code = f"import sys, importlib; [importlib.import_module(n) for n in {names!r}]"
    code += "; print([n for n in sys.modules if n.startswith('rmfs.solvers.') and "
    code += "n.split('.')[2] != 'decisions'])"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "[]"


@pytest.mark.parametrize("family", SCHEMAS)
def test_the_value_is_that_of_the_model(family: str) -> None:
    for seed in range(8):
        question = sample(family, seed)
        for method in methods(family):
            if method == "flow" and question.sizes.get("Z", 2) != 2:
                continue  # it knows two zones
            found = solve(question, method)
            if found.values is not None:
                value = check(question, found)
                assert value == pytest.approx(found.objective, rel=1e-9, abs=1e-9)


INDEX = {
    "pile_on": {"line_station": "S", "pod_station": "S", "prospect": "S", "pod_robot": "R"},
    "planning": {"pods": "P", "order_station": "S", "line_visit": "L"},
    "sequencing": {"pods": "P", "start": "O"},
    "sequence": {"tasks": "T", "place": "L", "robot_place": "L"},
    "rack_allocation": {"order_station": "S", "pod_station": "S"},
    "replenishment": {"pod": "P", "station": "S"},
    "placement": {"place": "L"},
    "stays": {"zone": "Z"},
    "charging": {"group": "G", "begin": "T", "length": "T"},
    "matching": {"robot": "R"},
    "balance": {"robot": "R"},
}
"""What the whole numbers of an answer count; the models take it for granted that it exists."""


def _changed(question: Decision, values: Any, rng: np.random.Generator) -> Any:
    """Change one or two numbers of an answer, within the ranges that the format allows."""
    values = {
        k: [list(r) for r in v] if isinstance(v, list) else v.copy() for k, v in values.items()
    }
    for _ in range(int(rng.integers(1, 3))):
        field = question.schema.values[int(rng.integers(len(question.schema.values)))]
        value = values[field.name]
        largest = question.sizes.get(INDEX.get(question.family, {}).get(field.name, ""), 0)
        if field.kind == "lists":
            row = value[int(rng.integers(len(value)))] if value else []
            if row and rng.random() < 0.5:
                row.pop(int(rng.integers(len(row))))
            else:
                row.append(int(rng.integers(largest)))
        elif value.size:
            at = tuple(int(rng.integers(n)) for n in value.shape)
            if field.kind == "flag":
                value[at] = 1 - value[at]
            elif field.kind == "real":
                value[at] = max(0.0, value[at] + rng.normal())
            else:
                value[at] = int(rng.integers(-(field.name != "pods"), largest))
    return values


def _by_model(question: Decision, values: Any) -> float | None:
    """What the model says: its objective, or None where it finds a violation or no such index."""
    found, data = model(question.family), model_data(question)
    try:
        made = model_values(question, values)
        if found.violations(data, made):
            return None
        worth = float(found.objective(data, made))
    except (IndexError, ValueError):
        return None
    return worth if np.isfinite(worth) else None


@pytest.mark.parametrize("family", SCHEMAS)
def test_models_and_checks_agree_on_changed_answers(family: str) -> None:
    rng = np.random.default_rng(7)
    right = wrong = 0
    for seed in range(40):
        question = sample(family, seed)
        found = solve(question, methods(family)[-1])
        if found.values is None:
            continue
        for _ in range(10):
            values = _changed(question, found.values, rng)
            expected = _by_model(question, values)
            try:
                value: float | None = check(question, Found(values))
            except WrongError:
                value = None
            assert (value is None) == (expected is None), (seed, values, value, expected)
            if value is not None:
                right += 1
                assert value == pytest.approx(expected, rel=1e-9, abs=1e-9)
            wrong += value is None
    assert right > 5
    assert wrong > 20


def test_stated_numbers_must_be_right() -> None:
    question = sample("matching", 0)
    found = solve(question)
    value = check(question, found)
    with pytest.raises(WrongError, match=r"objective: is .*, but the values give"):
        check(question, Found(found.values, objective=value - 1.0))
    with pytest.raises(WrongError, match=r"bound: .* contradicts"):
        check(question, Found(found.values, bound=value + 1.0))
    with pytest.raises(WrongError, match="contains no answer"):
        check(question, Found(None))
