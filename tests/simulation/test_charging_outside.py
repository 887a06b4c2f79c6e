"""Robots that must charge store their pods first: whoever decides where, is heard."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest
from ledger import Ledger
from test_stepping import follow, told

import rmfs

GIVEN = {
    "layout.robots": 12,
    "layout.other_stations.charger": {
        "kind": "charger",
        "within": 2,
        "parameters": {"power_w": 600.0},
    },
    "scenario.warmup_s": 0,
    "scenario.duration_s": 500,
    "scenario.energy.battery": {"capacity_wh": 30.0, "initial_least_share": 0.3},
    "controllers.psa": "random",
}
"""A battery holds too little for most tasks, so that robots with pods are often stopped."""


def simulation(*outside: str, **given: Any) -> rmfs.Simulation:
    keys = GIVEN | {key.replace("__", "."): value for key, value in given.items()}
    return rmfs.Simulation("small", "small", seed=1, set=keys, outside=outside, trace=True)


@pytest.mark.parametrize("outside", ["psa", "psa pps", "psa ca repositioning"])
def test_a_run_that_follows_the_advice_is_the_run_of_the_rule(outside: str) -> None:
    inside = simulation()
    inside.run()
    run = simulation(*outside.split())
    assert follow(run) > 0
    assert told(run) == told(inside)


@pytest.mark.parametrize("outside", ["psa", "psa pps"])
def test_nobody_is_asked_for_ever_about_pods_that_are_not_to_be_stored(outside: str) -> None:
    """Whoever declines is asked about a robot when it is stopped, and when TA gives tasks."""
    run = simulation(*outside.split())
    asked: Counter[tuple[int, int]] = Counter()
    while run.now_s < 300.0 and (decision := run.step()) is not None:
        if decision.problem == "psa":
            asked[run.now_us, decision.robot.index] += 1
            assert max(asked.values()) <= 2
            decision.decline()
        else:
            decision.answer(decision.advice())
    at_once = Counter(now_us for now_us, _ in asked)
    assert max(at_once.values()) > 1


@pytest.mark.parametrize("rule", ["routes", "brute-force"])
def test_a_ta_rule_that_decides_psa_itself_is_asked_for_places(rule: str) -> None:
    ledger = Ledger()
    joint = {f"controllers.{problem}": "dummy" for problem in ("pps", "psa")}
    run = rmfs.simulate(
        "small",
        "small",
        seed=1,
        set=GIVEN | joint | {"controllers.ta": rule},
        observers=[ledger],
        trace=True,
    )
    assert run.footprint["units_picked"] > 0
    assert run.check().ok
    ledger.check()
