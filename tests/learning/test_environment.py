"""The environment: Gymnasium's own checks, seeds, and runs that follow the rules."""

from __future__ import annotations

import importlib.util
import sys
import warnings
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import rmfs
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.learning import NAME, DecisionEnv, Reward
from rmfs.measure.dictionary import reproducible
from rmfs.simulation.idle_rules import IdleRuleWarning

RULES_FILE = Path(__file__).parents[1] / "simulation" / "every_rule.py"
sys.path.append(str(RULES_FILE.parent))
_spec = importlib.util.spec_from_file_location("every_rule", RULES_FILE)
assert _spec is not None and _spec.loader is not None
every_rule: Any = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(every_rule)

CHARGERS = {
    "layout.robots": 8,
    "scenario.energy": {
        "battery": {"capacity_wh": 150.0, "initial_least_share": 0.3, "initial_most_share": 0.6}
    },
    "layout.other_stations.charger": {
        "kind": "charger",
        "north": 3,
        "parameters": {"power_w": 600.0},
    },
}
PROBLEMS = ["poa", "roa", "rps", "pps", "psa", "ta", "sa", "mm", "repositioning"]
ASKED = {
    "mm": {"controllers.mm": {"name": "random", **every_rule.PARAMETERS["mm", "random"]}},
    "repositioning": {
        "controllers.repositioning": "utility",
        "controllers.ta": {"name": "balanced", "reposition_weight": 2.0},
    },
}
"""By default these two are never asked."""


def made(*problems: str, duration_s: float = 240, **given: Any) -> DecisionEnv:
    keys = {"scenario.duration_s": duration_s}
    for problem in problems:
        keys |= ASKED.get(problem, {})
    keys |= given.pop("set", {})
    return DecisionEnv("small", "small", problems=problems, set=keys, **given)


@pytest.mark.parametrize("problem", PROBLEMS)
def test_gymnasium_accepts_the_environment_of_every_problem(problem: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(made(problem, rule=problem == "mm"), skip_render_check=True)


def test_charging_is_decided_like_all_else() -> None:
    """CA needs a site with batteries; who follows its rule gets its footprint."""
    keys = CHARGERS | {"scenario.duration_s": 400, "scenario.warmup_s": 0}
    env = DecisionEnv("default", "default", problems=["ca"], set=keys, rule=True)
    check_env(env, skip_render_check=True)
    _, _, outside = played(env, 2, lambda env, info: env.decline + 1)
    inside = rmfs.simulate("default", "default", seed=2, set=keys)
    assert same(outside, inside.footprint)
    assert inside.footprint["charges"] > 0


def test_all_problems_at_once_and_flat() -> None:
    check_env(made(*PROBLEMS, observation="flat"), skip_render_check=True)
    registered = gymnasium.make(NAME, problems=["psa"], set={"scenario.duration_s": 100})
    observation, info = registered.reset(seed=3)
    assert registered.observation_space.contains(observation)
    assert list(info["action_mask"]) == list(observation["action_mask"].astype(bool))


def played(env: DecisionEnv, seed: int, choose: Any) -> tuple[list[Any], float, Any]:
    """Play an episode; returns what was seen, the rewards added up, and the footprint."""
    observation, info = env.reset(seed=seed)
    seen, total = [observation["candidates"].tobytes()], 0.0
    while "footprint" not in info:
        observation, reward, terminated, _, info = env.step(choose(env, info))
        assert not terminated
        seen.append((observation["global"].tobytes(), reward, info["now_s"]))
        total += reward
    return seen, total, info["footprint"]


def at_random(env: DecisionEnv, info: dict[str, Any]) -> int:
    return int(env.action_space.sample(info["action_mask"].astype(np.int8)))


@pytest.mark.parametrize("problems", [["pps"], ["ta", "pps"], ["poa", "psa"]])
def test_a_seed_and_the_same_actions_give_the_same_episode(problems: list[str]) -> None:
    episodes = []
    for env in (made(*problems), made(*problems)):
        env.action_space.seed(7)
        episodes.append(played(env, 5, at_random))
        for _ in range(2):  # at last as a copy of what was kept
            env.action_space.seed(7)
            episodes.append(played(env, 5, at_random))
    first, *others = episodes
    for other in others:
        assert other[0] == first[0]
        assert same(other[2], first[2])
    assert played(made(*problems), 6, at_random)[0] != first[0]


def same(one: Any, other: Any) -> bool:
    columns = reproducible("footprint")
    texts = [each[columns].to_json(double_precision=15) for each in (one, other)]
    return bool(texts[0] == texts[1])


RULES = every_rule.rules_of(*(problem for problem in Problem if problem is not Problem.PP))


@pytest.mark.parametrize(("problem", "name"), RULES, ids=[f"{p}-{n}" for p, n in RULES])
def test_who_follows_a_rule_gets_its_footprint(problem: Problem, name: str) -> None:
    tables = every_rule.tables_of(problem, name)
    keys = {f"controllers.{key}": table for key, table in tables.items()}
    keys |= {"scenario.duration_s": 240}
    env = DecisionEnv("small", "small", problems=[str(problem)], set=keys, rule=True)
    _, units, outside = played(env, 2, lambda env, info: env.decline + 1)
    inside = rmfs.simulate("small", "small", seed=2, set=keys)
    assert same(outside, inside.footprint)
    assert units <= inside.footprint["units_picked"]


@pytest.mark.parametrize(
    ("problems", "rules", "share"),
    [
        (("pps", "psa"), {}, 1 / 2),
        (("rps",), {}, 1 / 5),
        (("rps",), {"controllers.rps": "nearest", "controllers.roa": "random"}, 1 / 20),
    ],
)
def test_a_candidate_the_rule_would_choose_does_the_same(problems, rules, share) -> None:
    """The action of the rule, and the one among the candidates that says the same.

    A turn of RPS goes on after a decision: what the rule would decide next depends on it.
    """
    keys = {"scenario.duration_s": 240} | rules
    env = DecisionEnv("small", "small", problems=problems, set=keys, rule=True, candidates=100)
    chosen = []

    def choose(env: DecisionEnv, info: dict[str, Any]) -> int:
        chosen.append(env.advised())
        return chosen[-1]

    _, _, outside = played(env, 2, choose)
    inside = rmfs.simulate("small", "small", seed=2, set=keys)
    assert same(outside, inside.footprint)
    assert sum(action < env.decline for action in chosen) > len(chosen) * share


def test_features_are_the_numbers_of_candidates() -> None:
    env = made("pps", rankings={"pick pod": {"reach_s": -1.0}})
    _, info = env.reset(seed=1)
    while info["kind"] != "pick pod":
        *_, info = env.step(0)
    options = env.options
    assert options is not None
    reach_s = options.decision.candidates.columns["reach_s"]
    place = [one.name for one in env.observing.features].index("reach_s")
    assert np.allclose(options.features[: len(options.rows), place], np.sort(reach_s)[:8] / 30)


def test_what_is_not_possible_counts_as_declining() -> None:
    env = made("pps")
    _, info = env.reset(seed=1)
    while info["action_mask"][7]:
        *_, info = env.step(0)
    *_, info = env.step(7)
    assert info["invalid"]


class Lifts(Reward):
    """1 for every pod lifted."""

    def pod_lifted(self, time_s: float, pod: int, robot: int, waypoint: int) -> None:
        self.amount += 1.0


def test_rewards_add_up_to_the_footprint() -> None:
    column = {"orders": "orders_completed", "distance": "distance_m", "late-orders": "orders_late"}
    given: dict[str, Any] = {
        "scenario.orders.due": {
            "mode": "priority",
            "urgent_share": 0.5,
            "urgent_offset_s": 20,
            "ordinary_offset_s": 100,
        },
    }
    for name in column:
        env = made("pps", reward={name: 2.0}, set=given)
        _, total, footprint = played(env, 4, at_random)
        sign = 1.0 if name == "orders" else -1.0
        assert footprint[column[name]] > 0
        assert total == pytest.approx(2.0 * sign * footprint[column[name]], abs=1e-6)
    env = made("pps", reward=Lifts, set=given)
    _, total, footprint = played(env, 4, at_random)
    assert total == footprint["pods_lifted"] > 0


def test_a_run_that_is_not_measured_goes_the_same_way() -> None:
    def seen(footprint: bool) -> list[Any]:
        env = made("ta", "pps", duration_s=400, footprint=footprint)
        _, info = env.reset(seed=3)
        found, over = [], False
        while not over:
            observation, reward, _, over, info = env.step(int(info["action_mask"].argmax()))
            found.append((info["now_s"], reward, observation["candidates"].tobytes()))
        assert ("footprint" in info) is footprint
        return found

    assert seen(True) == seen(False)
    keys = {"scenario.duration_s": 30}
    run = rmfs.Simulation("small", "small", set=keys, measured=False)
    run.run()
    with pytest.raises(InputError, match="measured=False"):
        run.result()


def test_time_passes_between_decisions() -> None:
    env = made("psa")
    _, info = env.reset(seed=1)
    total = info["elapsed_s"]
    while "footprint" not in info:
        *_, info = env.step(0)
        total += info["elapsed_s"]
    assert total == pytest.approx(240)


def test_no_rule_is_blamed_for_an_agent_that_decides_nothing() -> None:
    env = made("poa", "ta", duration_s=900)
    with warnings.catch_warnings():
        warnings.simplefilter("error", IdleRuleWarning)
        _, _, footprint = played(env, 1, lambda env, info: env.decline)
    assert footprint["units_picked"] == 0


def test_a_picture_of_the_run() -> None:
    env = made("ta", render_mode="rgb_array")
    env.reset(seed=1)
    before = env.render()
    for _ in range(10):
        env.step(0)
    after = env.render()
    assert before.shape == after.shape == (480, 640, 3)
    assert before.dtype == np.uint8
    assert (before != after).any()


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"problems": ["pp"]}, "problem pp: must be one of poa"),
        ({"problems": "pps"}, r'problems pps: must be a list, such as \["pps"\]'),
        ({"reward": {"units": float("nan")}}, "reward units: its weight must be a number"),
        ({"reward": {"units": "1"}}, "reward units: its weight must be a number"),
        ({"candidates": 0}, "candidates: must be 1 or more"),
        ({"reward": "profit"}, "reward profit: must be one of units"),
        (
            {"rankings": {"pick pod": {"price": 1}}},
            "rankings.pick pod.price: unknown feature; valid: units",
        ),
        ({"observation": "picture"}, "observation: must be dict or flat"),
    ],
)
def test_wrong_settings_are_refused(given: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=told):
        DecisionEnv("small", "small", **given)
