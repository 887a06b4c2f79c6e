"""Network rules in the environment, and their training by PPO."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import rmfs
from rmfs import control
from rmfs.cli import main
from rmfs.control.features import COLUMNS
from rmfs.control.network import Layer, Network, Scorer, start
from rmfs.control.overview import GLOBAL_FEATURES
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.learning import DecisionEnv
from rmfs.learning.networks import KINDS, first_networks, network_rules
from rmfs.learning.ppo import train_network
from rmfs.learning.rewards import OverdueOrders
from rmfs.learning.training import Task
from rmfs.measure.dictionary import reproducible
from rmfs.world.orders import Order

LATE = {
    "scenario.duration_s": 600,
    "scenario.demand.orders_per_h": 200,
    "scenario.orders.due.urgent_share": 0.5,
    "scenario.orders.due.urgent_offset_s": 100,
    "layout.robots": 5,
}
SITES: dict[str, tuple[str, dict[str, Any]]] = {
    "backlog": ("small", {"scenario.duration_s": 400, "layout.robots": 4}),
    "arrivals": ("small-arrivals", LATE),
}
TASK = Task("small", "small", problems=("poa", "psa"), seeds=(1,), set={"scenario.duration_s": 60})


def shaken(kind: str, seed: int) -> Network:
    """The first network of a kind of question, with a random layer that changes its choices."""
    draw = np.random.default_rng(seed)
    inputs = (*COLUMNS[kind], *(f"all.{one.name}" for one in GLOBAL_FEATURES))
    given = draw.normal(size=(len(inputs), 6)).tolist()
    first = Layer(weights=tuple(map(tuple, given)), biases=tuple(draw.normal(size=6).tolist()))
    last = tuple((value,) for value in draw.normal(size=6).tolist())
    known = start(kind)
    decline = None if known.decline is None else {**known.decline, "open_units": 0.5}
    layers = (first, Layer(weights=last, biases=(0.5,)))
    return Network(linear=known.linear, decline=decline, inputs=inputs, layers=layers)


def played(env: DecisionEnv, scorers: dict[str, Scorer], seed: int) -> tuple[Any, int]:
    """Let networks choose among the actions of an environment, as a policy does."""
    observing = env.observing
    names = [feature.name for feature in observing.features]
    places = {kind: [names.index(name) for name in COLUMNS[kind]] for kind in observing.kinds}
    seen, info = env.reset(seed=seed)
    steps = 0
    while "footprint" not in info:
        scorer = scorers[info["kind"]]
        whole = seen["global"][: len(GLOBAL_FEATURES)]
        scores = scorer.scores(seen["candidates"][:, places[scorer.kind]], whole)
        declining = scorer.declining(whole)
        scores = np.append(scores, -np.inf if declining is None else declining)
        chosen = np.where(info["action_mask"], scores, -np.inf)
        seen, _, _, _, info = env.step(int(chosen.argmax()))
        steps += 1
    return info["footprint"], steps


@pytest.mark.parametrize("site", list(SITES))
@pytest.mark.parametrize("problems", [("poa", "pps", "psa", "ta"), ("poa",), ("ta",), ("pps",)])
def test_rules_and_policy_have_the_same_footprint(site: str, problems: tuple[str, ...]) -> None:
    scenario, given = SITES[site]
    task = Task("small", scenario, problems=problems, set=given)
    kinds = [kind for one in problems for kind in KINDS[Problem(one)].values()]
    networks = {kind: shaken(kind, 7) for kind in kinds}
    rules = network_rules(task, networks, candidates=6)
    found = rmfs.simulate("small", scenario, rules, seed=5, set=given).footprint
    env = DecisionEnv("small", scenario, rules, problems=problems, set=given, candidates=6)
    scorers = {kind: Scorer(kind, network, 6) for kind, network in networks.items()}
    other, steps = played(env, scorers, 5)
    assert steps > 15
    columns = reproducible("footprint")
    texts = [each[columns].to_json(double_precision=15) for each in (found, other)]
    assert texts[0] == texts[1]
    assert found["units_picked"] > 20


def test_the_layers_of_that_test_change_decisions() -> None:
    kinds = {kind: shaken(kind, 7) for one in KINDS.values() for kind in one.values()}
    task = Task("small", "small", problems=("poa", "pps", "psa", "ta"), set=SITES["backlog"][1])
    driven = [
        rmfs.simulate("small", "small", network_rules(task, given), seed=5, set=task.set)
        for given in (kinds, {kind: start(kind) for kind in kinds})
    ]
    assert driven[0].footprint["distance_m"] != driven[1].footprint["distance_m"]


def test_overdue_orders_count_when_their_due_time_passes() -> None:
    scenario, given = SITES["arrivals"]
    env = DecisionEnv("small", scenario, problems=["psa"], set=given, reward="overdue-orders")
    total = 0.0
    _, info = env.reset(seed=2)
    while "footprint" not in info:
        _, reward, _, _, info = env.step(0)
        total += reward
    # from reset to the first decision, no order is overdue
    footprint = info["footprint"]
    assert -total == footprint["orders_late"] + footprint["orders_overdue_end"] > 10


@pytest.mark.parametrize("asked_at_s", [[], [15.0], [15.0, 25.0]])
def test_orders_cancelled_when_overdue_count_whenever_the_reward_is_asked_for(asked_at_s) -> None:
    """Due at 10 s: one order is cancelled at 5 s, one at 20 s, and one stays."""
    world = SimpleNamespace(now_s=0.0)
    reward, total = OverdueOrders(), 0.0
    reward.run_started(SimpleNamespace(world=world))
    orders = [Order.of(index, 0.0, 10.0, (0,), (1,)) for index in range(3)]
    for order in orders:
        reward.order_created(order)
    for time_s in sorted([5.0, 20.0, *asked_at_s, 30.0]):
        world.now_s = time_s
        if time_s in (5.0, 20.0):
            reward.order_cancelled(orders[0 if time_s == 5.0 else 1])
        else:
            total += reward.take()
    assert total == -2.0


def test_stored_units_count() -> None:
    given = {"scenario.duration_s": 400, "layout.robots": 4}
    env = DecisionEnv("small", "small", problems=["psa"], set=given, reward="units-stored")
    _, info = env.reset(seed=2)
    total = 0.0
    while "footprint" not in info:
        _, reward, _, _, info = env.step(0)
        total += reward
    assert total == info["footprint"]["units_stored"] > 0


@pytest.mark.parametrize("given", [{"steps": 0}, {"gamma": 1.5}, {"learning_rate": 0.0}])
def test_wrong_numbers_are_refused(given: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="training needs steps"):
        train_network(TASK, **given)


def test_training_goes_on_from_network_rules() -> None:
    assert first_networks(TASK) == {"poa": start("poa"), "place": start("place")}
    mine = {"linear": {"away_s": -2.0}}
    task = replace(TASK, set={**TASK.set, "controllers.psa": {"name": "network", "network": mine}})
    assert first_networks(task)["place"] == Network(linear={"away_s": -2.0})


def test_the_packages_that_training_needs_are_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "torch", None)
    monkeypatch.delitem(sys.modules, "rmfs.learning.ppo_run", raising=False)
    out = tmp_path / "mine.toml"
    assert main(["learn-network", "--out", str(out), "--steps", "10"]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert "needs the package torch: pip install rmfs[learning,ppo]" in message
    assert not out.exists()


# --- with the extra `ppo` -------------------------------------------------------------------------


def test_the_policy_is_the_network() -> None:
    """Scores in PyTorch are those of NumPy, before and after a network is written."""
    pytest.importorskip("sb3_contrib")
    import torch

    from rmfs.learning.scoring import Scores

    problems = ("poa", "pps", "psa", "ta")
    env = DecisionEnv("small", "small", problems=problems, candidates=6, observation="flat")
    observing = env.observing
    networks = {kind: shaken(kind, 3) for kind in observing.kinds}
    module = Scores(observing, networks, hidden=8)
    exported = {one.kind: one.network(17) for one in module.scorers}
    draw = np.random.default_rng(1)
    count, wide = len(observing.features), len(GLOBAL_FEATURES)
    names = [feature.name for feature in observing.features]
    for kind in observing.kinds:
        asked = [float(kind == one) for one in observing.kinds]
        whole = draw.normal(size=wide).astype(np.float32)
        candidates = draw.normal(size=(6, count)).astype(np.float32)
        seen = np.concatenate([whole, asked, candidates.ravel()]).astype(np.float32)
        with torch.no_grad():
            found = module.forward_actor(torch.as_tensor(seen)[None])[0].numpy()
        own = candidates[:, [names.index(name) for name in COLUMNS[kind]]]
        for given in (networks, exported):
            scorer = Scorer(kind, given[kind])
            np.testing.assert_allclose(found[:-1], scorer.scores(own, whole), atol=1e-4)
            declining = scorer.declining(whole)
            if declining is None:
                assert found[-1] < -1000
            else:
                assert found[-1] == pytest.approx(declining, abs=1e-4)


def test_the_mean_reward_is_subtracted_by_time() -> None:
    pytest.importorskip("sb3_contrib")
    from rmfs.learning.ppo_run import Rate

    rate = Rate()
    draw = np.random.default_rng(1)
    times_s = draw.exponential(2.0, 20_000)
    left = [rate.less_mean(0.5 * time_s + draw.normal(), time_s) for time_s in times_s]
    assert abs(np.mean(left[5_000:])) < 0.05
    assert Rate().less_mean(3.0, 0.0) == 0.0
    # more reward in the same time is above the mean
    assert rate.less_mean(3.0, 1.0) > 2.0 > rate.less_mean(3.0, 10.0)


def test_training_repeats_and_writes_a_file_that_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("sb3_contrib")
    files = []
    for name in ("one", "two"):
        out = tmp_path / name / "mine.toml"
        out.parent.mkdir()
        arguments = [
            *("learn-network", "--out", str(out), "--problems", "poa,psa", "--seeds", "1"),
            *("--steps", "4000", "--checks", "2", "--set", "scenario.duration_s=100"),
            # every network is better than this one, so the result is a trained one
            *("--set", "controllers.poa.name=network"),
            *("--set", "controllers.poa.network={decline={constant=-1},linear={age_s=-1}}"),
        ]
        assert main(arguments) == 0
        assert "4096 decisions: objective" in capsys.readouterr().out
        files.append(out.read_text())
        assert " 4096 decisions, " in files[-1]
    assert files[0] == files[1]
    settings = control.load(tmp_path / "one" / "mine.toml")
    network = settings.to_table()["psa"]["network"]
    assert len(network["layers"]) == 2
    run = rmfs.simulate("small", "small", settings, seed=1, set={"scenario.duration_s": 60})
    assert run.footprint["controllers"] == "mine"
