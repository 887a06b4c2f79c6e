"""Runs in which much goes wrong: whatever the seed, they are safe and come to their end."""

import random

import pytest
from ledger import Ledger

from rmfs import simulate
from rmfs.world import verify
from tests.tools.proof import proven

CLOSURES = {"closures": {"every_s": 60.0, "lasting_s": 60.0}}


def driven(layout, scenario, controllers, seed, duration_s, disturbances, **rules):
    ledger = Ledger()
    overrides = [
        (["scenario", "duration_s"], duration_s),
        (["scenario", "warmup_s"], 0.0),
        *((["scenario", "disturbances", kind], given) for kind, given in disturbances.items()),
        *((["controllers", *path.split("__")], value) for path, value in rules.items()),
    ]
    run = simulate(
        layout,
        scenario,
        controllers,
        seed=seed,
        trace=True,
        overrides=overrides,
        observers=[ledger],
    )
    report = run.check()
    assert report.ok, report.summary()
    verify(run.world)
    ledger.check()
    return run


@pytest.mark.parametrize("seed", [22, 31])
def test_a_closure_while_a_robot_lifts(seed):
    """The way planned ahead to a place in a queue is cut off: the robot tries again later."""
    run = driven("small", "small-arrivals", "default", seed, 3600.0, CLOSURES)
    assert run.footprint["disturbances"] > 30


def drawn(number):
    """A case by its number: layout, scenario, controllers, what goes wrong, who plans."""
    draw = random.Random(number)
    site = draw.choice(
        [("small", "small-arrivals"), ("small", "small"), ("study-tiers", "pp-minimal")]
    )
    rules = draw.choice(["default", "default", "random"])
    wrong = {
        "closures": {
            "every_s": draw.choice([20.0, 60.0, 150.0]),
            "lasting_s": draw.choice([20.0, 60.0, 300.0]),
        }
    }
    if draw.random() < 0.4:
        wrong["breakdowns"] = {"every_s": 20.0, "lasting_s": draw.choice([10.0, 100.0])}
    if draw.random() < 0.4:
        wrong["slow"] = {"every_s": 30.0, "lasting_s": 60.0, "speed_share": 0.4}
    if site[0] == "study-tiers" and draw.random() < 0.7:
        wrong["elevators_out"] = [[0, 50.0, 200.0], [1, 150.0, 250.0]]
    planner = draw.choice(["time-windows"] * 6 + ["whca-n", "pibt", "far"])
    return (*site, rules), wrong, {} if planner == "time-windows" else {"pp__name": planner}


@pytest.mark.parametrize("number", range(16))
def test_short_runs(number):
    names, wrong, rules = drawn(number)
    assert driven(*names, number, 300.0, wrong, **rules).footprint["distance_m"] > 100


@pytest.mark.slow
@pytest.mark.parametrize("number", range(1_000, 1_200))
def test_long_runs(number):
    names, wrong, rules = drawn(number)
    assert driven(*names, number, 1800.0, wrong, **rules).footprint["distance_m"] > 100


@pytest.mark.slow
def test_delays_that_come_back_to_who_is_late() -> None:
    """Four runs around a block each wait for the next: the delay is refused, not endless."""
    row = proven(285)
    assert row.problem == ""
    assert row.disturbances > 150
