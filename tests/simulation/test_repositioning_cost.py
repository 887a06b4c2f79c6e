"""Repositioning in a crowd: the work per decision does not grow with the site."""

from __future__ import annotations

import pytest

from rmfs.control.problems import Problem
from rmfs.control.repositioning import utility
from rmfs.simulation.run import Simulation

LIGHT = {"scenario.skus.count": 100, "scenario.skus.space_per_unit.value": 5.0}


def crowded(layout: str, robots: int) -> Simulation:
    """Two minutes of repositioning with many robots."""
    simulation = Simulation(
        layout,
        "pp-minimal",
        set={
            **LIGHT,
            "layout.robots": robots,
            "scenario.warmup_s": 0.0,
            "scenario.duration_s": 120.0,
            "controllers.repositioning.name": "utility",
        },
        measured=False,
    )
    simulation.run()
    return simulation


def questions_and_labels(robots: int) -> tuple[int, float]:
    """One tier, so many robots, for two minutes: moves, and labels per question.

    The planner looks at labels; every leg, failed or not, is a question. With elevators, labels per
    question grow, because trips that need a ride are planned by the usual search.
    """
    simulation = crowded("study-128", robots)
    counted = simulation.traffic.counters()
    questions = counted["plans"] + counted["replans"] + counted["plan_failures"]
    moves = simulation.deciding.statistics[Problem.REPOSITIONING].calls
    return moves, counted["expansions"] / questions


def test_labels_per_question_do_not_grow_with_the_fleet() -> None:
    """Robots that find no way in a crowd ask again after longer and longer pauses."""
    moves, few = questions_and_labels(robots=160)
    more_moves, many = questions_and_labels(robots=320)
    assert moves >= 30 and more_moves > 1.5 * moves
    assert many < 1.2 * few
    assert few < 400


def test_robots_that_wait_for_elevators_do_not_ask_all_the_time() -> None:
    """On three tiers with 80 robots on each, most searches find a way, and labels are limited."""
    counted = crowded("study-tiers", 80).traffic.counters()
    questions = counted["plans"] + counted["replans"] + counted["plan_failures"]
    assert counted["plan_failures"] < 0.5 * counted["plans"]
    assert counted["expansions"] < 2_000 * questions


@pytest.mark.parametrize(
    ("layout", "robots"), [("small", 24), ("study-32", 64), ("study-tiers", 32)]
)
def test_few_pods_are_looked_at_per_decision(
    layout: str, robots: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = {"pods": 0, "decisions": 0}
    nearest, find = utility.nearest_place, utility.Utility.find

    def counted_place(*given):
        looked["pods"] += 1
        return nearest(*given)

    def counted_find(rule, robot):
        looked["decisions"] += 1
        before = looked["pods"]
        found = find(rule, robot)
        assert looked["pods"] - before <= 8
        return found

    monkeypatch.setattr(utility, "nearest_place", counted_place)
    monkeypatch.setattr(utility.Utility, "find", counted_find)
    crowded(layout, robots)
    assert looked["decisions"] > 0
