"""A fork goes on as the original does, bit for bit, and neither changes the other."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_stepping import follow, simulation, take, told

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
        {"scenario__skus__affinity": {"share": 0.5, "pairs": 200}},
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


FOLLOWED: dict[str, tuple[str, dict[str, Any]]] = {
    **{
        f"rps {name}": ("rps", {"controllers__rps": {"name": name, "buffer_threshold": 0.5}})
        for name in ("emptiest", "correlative", "random")
    },
    "rps turnover": ("rps", {"controllers__rps": "turnover"}),
    "rps reactive": ("rps", {"controllers__rps": "reactive", "controllers__roa": "random"}),
    "roa": ("roa", {}),
    "roa one by one": ("roa", {"controllers__roa": {"name": "same-pod", "break_batches": True}}),
    "roa random": ("roa", {"controllers": "random"}),
    "poa": ("poa", {"controllers": "random"}),
    "poa queue": ("poa", {"controllers__poa": "queue"}),
    "psa": ("psa", {"controllers__psa": "random"}),
    "sa": ("sa", {"controllers__sa": {"name": "backlog-threshold", "pause_s": 60.0}}),
    "ta": ("ta", {"controllers": "random"}),
    "ta brute-force": (
        "ta",
        {
            "controllers__ta": "brute-force",
            "controllers__pps": "dummy",
            "controllers__psa": "dummy",
        },
    ),
}


@pytest.mark.parametrize("name", FOLLOWED)
def test_where_the_advice_of_a_rule_is_followed(name: str) -> None:
    """At random moments: in the middle of a turn, before and after the advice is given."""
    problem, given = FOLLOWED[name]
    moments = 2 * follow(simulation(problem, **given))
    chosen = set(random.Random(name).sample(range(moments), min(moments, 16)))
    run, moment, forks = simulation(problem, **given), 0, []
    while (decision := run.step()) is not None:
        if moment in chosen:
            forks.append(run.fork())
        decision.advice()
        if moment + 1 in chosen:
            forks.append(run.fork())
        take(decision)
        moment += 2
    assert len(forks) == len(chosen)
    for fork in forks:
        follow(fork)
        assert told(fork) == told(run)


def test_a_saved_turn_goes_on(tmp_path: Path) -> None:
    """The advisor of RPS is in the file."""
    run, saved = simulation("rps"), []
    while (decision := run.step()) is not None:
        take(decision)
        if run.decision is not None and len(saved) < 5:
            saved.append(tmp_path / f"{len(saved)}.run")
            run.save(saved[-1])
    for path in saved:
        loaded = rmfs.Simulation.load(path)
        follow(loaded)
        assert told(loaded) == told(run)


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
