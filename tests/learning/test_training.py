"""Linear rules, and their training."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rmfs
from rmfs import control
from rmfs.cli import main
from rmfs.control.linear import default_weights
from rmfs.errors import InputError
from rmfs.learning.training import Task, train
from rmfs.simulation.idle_rules import IdleRuleWarning

KEYS = {"scenario.duration_s": 300, "layout.robots": 4}
TURNOVER = {"order_turnover_mean_s": -1.0}
TASK = Task("small", "small", set=KEYS | {"scenario.duration_s": 100}, seeds=(1, 2))


def units(*, seed: int = 1, **rules: Any) -> int:
    keys = KEYS | {f"controllers.{problem}": rule for problem, rule in rules.items()}
    return int(rmfs.simulate("small", "small", seed=seed, set=keys).footprint["units_picked"])


def test_linear_rules_decide_everything() -> None:
    keys = KEYS | {f"controllers.{problem}": "linear" for problem in ("poa", "pps", "psa", "ta")}
    run = rmfs.simulate("small", "small", seed=1, set=keys, trace=True)
    assert run.footprint["units_picked"] > 20
    assert run.check().ok


def test_weights_matter() -> None:
    far = {"name": "linear", "weights": {"away_s": 1.0}}
    near = {"name": "linear", "weights": {"away_s": -1.0}}
    assert units(psa=near) > units(psa=far)
    nearest = rmfs.simulate("small", "small", seed=1, set=KEYS | {"controllers.psa": "nearest"})
    assert units(psa=near) == nearest.footprint["units_picked"]


@pytest.mark.parametrize("lane", [True, False])
def test_linear_order_assignment_can_be_pod_match(lane: bool) -> None:
    """Spare units on inbound pods, then due times: the same orders to the same stations."""
    weights = {"inbound_units": 1.0, "due_in_s": -1e-5}
    linear = {"name": "linear", "weights": weights, "fast_lane": lane}
    match = {"name": "pod-match", "fast_lane": lane}
    found = [
        rmfs.simulate("small", "small", seed=3, set=KEYS | {"controllers.poa": rule}, trace=True)
        for rule in (linear, match)
    ]
    assert found[0].footprint["orders_completed"] > 5
    for name, table in found[0].trace.items():
        np.testing.assert_array_equal(table, found[1].trace[name], name)


def test_linear_tasks_follow_their_weights() -> None:
    """Stations that are valued get robots, and others none."""
    given = KEYS | {"scenario.duration_s": 600}
    stored = []
    for pick in (20.0, -20.0):
        rule = {"name": "linear", "weights": {"work": 10.0, "store": 5.0, "pick": pick}}
        rule["weights"]["rest"] = 0.0 if pick < 0 else -20.0
        run = rmfs.simulate("small", "small", seed=1, set=given | {"controllers.ta": rule})
        stored.append(run.footprint["units_picked"])
    assert stored[0] > 30
    assert stored[1] == 0


def test_training_repeats_and_improves_what_it_was_trained_on() -> None:
    found = [train(TASK, generations=2, population=4, seed=5, jobs=jobs) for jobs in (1, 1, 2)]
    assert found[0].settings == found[1].settings == found[2].settings
    assert found[0].value >= found[0].start_value
    assert list(found[0].history["generation"]) == [1, 2]
    again = [train_value(found[0].settings, seed) for seed in TASK.seeds]
    assert found[0].value == sum(again) / len(again)


def train_value(settings: control.ControllerSettings, seed: int) -> int:
    run = rmfs.simulate("small", "small", settings, seed=seed, set=dict(TASK.set))
    return int(run.footprint["units_picked"])


def test_the_command_writes_a_file_that_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "mine.toml"
    arguments = [
        *("learn", "--out", str(out), "--problems", "psa", "--seeds", "1", "--generations", "1"),
        *("--population", "4", "--set", "scenario.duration_s=120"),
    ]
    assert main(arguments) == 0
    assert "generation 1: best" in capsys.readouterr().out
    settings = control.load(out)
    assert settings.name == "mine"
    weights = settings.to_table()["psa"]["weights"]
    assert weights.keys() == default_weights("place").keys()
    run = rmfs.simulate("small", "small", out, seed=1, set={"scenario.duration_s": 60})
    assert run.footprint["controllers"] == "mine"


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"problems": ["sa"]}, "problem sa: must be one of poa, pps, psa, ta"),
        ({"objective": {"profit": 1.0}}, "objective profit: is not a column of the footprint"),
        ({"seeds": ()}, "at least one problem, one objective and one seed"),
    ],
)
def test_wrong_tasks_are_refused(given: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=told):
        Task("small", "small", **given)


def test_rules_that_do_nothing_are_not_the_best() -> None:
    """If all robots rest, no order is completed, and there is no mean turnover to be small."""
    task = Task("small", "small", problems=("ta",), objective=TURNOVER, set=KEYS, seeds=(1,))
    weights = task.start()
    names = list(default_weights("ta"))
    run = rmfs.simulate("small", "small", task.settings(weights), seed=1, set=KEYS)
    assert task.worth(weights, 1) == -run.footprint["order_turnover_mean_s"] < 0
    weights[names.index("rest")] = 5.0
    with pytest.warns(IdleRuleWarning):
        idle = rmfs.simulate("small", "small", task.settings(weights), seed=1, set=KEYS)
    assert idle.footprint["orders_completed"] == 0
    assert task.worth(weights, 1) < task.worth(task.start(), 1)


def test_an_objective_of_text_is_refused() -> None:
    task = Task("small", "small", problems=("psa",), objective={"layout": 1.0}, set=KEYS)
    with pytest.raises(InputError, match="objective layout: is a column of text"):
        task.worth(task.start(), 1)


def test_an_objective_without_a_value_is_refused() -> None:
    """In five seconds, no order is completed."""
    keys = KEYS | {"scenario.duration_s": 5}
    task = Task("small", "small", problems=("psa",), objective=TURNOVER, set=keys, seeds=(1,))
    with pytest.raises(InputError, match="objective order_turnover_mean_s: must have a value"):
        train(task, generations=1, population=4)


def test_a_feature_that_does_not_exist_is_named() -> None:
    with pytest.raises(InputError, match=r"price is not a feature of .*; valid: away_s, back_s"):
        units(psa={"name": "linear", "weights": {"price": 1.0}})
