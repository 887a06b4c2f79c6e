"""A fork goes on as the original does, bit for bit, and neither changes the other."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import pytest
from test_stepping import simulation, told

import rmfs
from rmfs.errors import InputError


def small(
    controllers: str, scenario: str = "small", pacing: str = "work", seed: int = 1
) -> rmfs.Simulation:
    """A small site with optimisers."""
    given = {"scenario.duration_s": 400}
    return rmfs.Simulation(
        "small", scenario, controllers, seed=seed, set=given, pacing=pacing, trace=True
    )


DISTURBED = {
    "scenario__disturbances__breakdowns": {"every_s": 60, "lasting_s": 20},
    "scenario__disturbances__slow": {"every_s": 80, "lasting_s": 30},
    "scenario__disturbances__closures": {"every_s": 100, "lasting_s": 30},
}


@pytest.mark.parametrize(
    "given",
    [
        {},
        DISTURBED,
        {"controllers": "random"},
        {"controllers__ta": "swarm", "controllers__repositioning": "utility"},
        {"controllers__poa": "queue", "controllers__psa": "turnover"},
        {"controllers__poa": {"name": "pod-match", "fast_lane": True}},
    ],
)
def test_at_random_moments(given: dict[str, Any]) -> None:
    run, draw = simulation(**given), random.Random(5)
    forks = []
    for time_s in sorted(draw.uniform(0, 260) for _ in range(4)):
        run.run_until(time_s)
        forks.append(run.fork())
    run.run()
    for fork in forks:
        fork.run()
        assert told(fork) == told(run)


@pytest.mark.parametrize(
    ("controllers", "scenario", "pacing"),
    [
        ("pile-on", "small", "work"),
        ("pile-on-dispatch", "small-arrivals", "work"),
        ("solver", "small", "work"),
        ("stocking", "small", "fixed=3"),
    ],
)
def test_with_optimisers_answers_under_way_included(
    controllers: str, scenario: str, pacing: str
) -> None:
    run = small(controllers, scenario, pacing)
    run.run_until(123.4)
    fork = run.fork()
    run.run()
    fork.run()
    assert told(fork) == told(run)


@pytest.mark.parametrize("problem", ["poa", "pps", "psa", "ta", "rps"])
def test_a_decision_that_waits_is_copied(problem: str) -> None:
    """The fork hands out the same question, and goes on alike with the same answers."""
    run = simulation(problem)
    for _ in range(12):
        decision = run.step()
        assert decision is not None
        if len(decision.candidates):
            decision.answer(decision.candidates[0])
        else:
            decision.decline()
    pending = run.step()
    fork = run.fork()
    again = fork.step()
    assert pending is not None and again is not None
    assert repr(again) == repr(pending)
    assert again.candidates.frame().equals(pending.candidates.frame())
    for one in (run, fork):
        for _ in range(30):
            decision = one.step()
            if decision is None:
                break
            if len(decision.candidates):
                decision.answer(decision.candidates[-1])
            else:
                decision.decline()
    assert told(fork) == told(run)


def test_neither_changes_the_other() -> None:
    run = simulation()
    run.run_until(100.0)
    before = told(run)
    fork = run.fork()
    fork.run()
    assert told(run) == before
    assert fork.world.units_picked > run.world.units_picked
    assert fork.world.robots[0] is not run.world.robots[0]
    assert fork.layout is run.layout


def test_views_of_arrays_stay_views() -> None:
    """What is written into a fork's arrays is seen by those who look at it."""
    run = simulation()
    run.run_until(50.0)
    fork = run.fork()
    world = fork.world
    assert np_shares(world.need, world.pick_stations[0].requests._need)
    assert np_shares(world.inventory.available, world.inventory._available)
    assert not world.inventory.available.flags.writeable
    assert not np_shares(world.need, run.world.need)


def np_shares(one: Any, other: Any) -> bool:
    return bool(np.shares_memory(one, other))


def test_a_run_paced_by_the_clock_cannot_be_copied() -> None:
    run = small("pile-on", pacing="wall")
    with pytest.raises(InputError, match="pacing wall cannot be copied"):
        run.fork()
