"""Dummies, joint controllers, and what may stand beside what."""

from __future__ import annotations

import pytest
from doubles import Situation, rules

from rmfs.control import registry
from rmfs.control.problems import Problem
from rmfs.errors import InputError

WITH_DUMMIES = [problem for problem in Problem if problem not in (Problem.MM, Problem.PP)]


def test_there_is_a_dummy_for_every_problem() -> None:
    for problem in WITH_DUMMIES:
        assert registry.find(problem, "dummy").is_dummy


@pytest.mark.parametrize("problem", WITH_DUMMIES)
def test_a_dummy_decides_nothing(problem) -> None:
    situation = Situation()
    dummy, robot = situation.make(registry.find(problem, "dummy")), situation.world.robots[0]
    assert not dummy.triggers | dummy.subscriptions
    match problem:
        case Problem.PPS:
            assert dummy.pick_pod(robot, situation.world.pick_stations[0]) == -1
            assert dummy.replenishment_pod(robot, situation.world.replenishment_stations[0]) == -1
            assert dummy.next_station(robot, [1, 0]) == 1
        case Problem.PSA:
            assert dummy.place(robot) == -1
        case Problem.REPOSITIONING:
            assert dummy.move(robot) is None
        case Problem.TA:
            assert list(dummy.decide(None)) == []
            assert dummy.rest_place(robot) == -1
        case _:
            assert list(dummy.decide()) == []


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        (
            {"ta": {"name": "random"}},
            "ta random decides pps as well: pps.name must be dummy (given: lexicographic)",
        ),
        (
            {"ta": {"name": "brute-force"}, "pps": {"name": "dummy"}},
            "ta brute-force decides psa as well: psa.name must be dummy (given: nearest)",
        ),
        (
            {"psa": {"name": "dummy"}},
            "psa.name: a dummy decides nothing, and no other controller decides psa",
        ),
        (
            {"ta": {"name": "random"}, "pps": {"name": "dummy"}, "psa": {"name": "dummy"}},
            "psa.name: a dummy decides nothing",
        ),
        (
            {"poa": {"name": "joint:Joint"}, "pps": {"name": "dummy"}},
            "poa joint:Joint decides psa as well",
        ),
        (
            {"psa": {"name": "cache"}, "repositioning": {"name": "cache", "cache_share": 0.1}},
            "psa.cache_share and repositioning.cache_share must be equal",
        ),
        (
            {"pps": {"reserve": "assigned"}},
            "reserve must include the requests of consider",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(tables, message) -> None:
    with pytest.raises(InputError) as error:
        rules(**tables)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_what_goes_together() -> None:
    rules(ta={"name": "random"}, pps={"name": "dummy", "late_picks": False})
    rules(ta={"name": "brute-force"}, pps={"name": "dummy"}, psa={"name": "dummy"})
    rules(poa={"name": "joint:Joint"}, pps={"name": "dummy"}, psa={"name": "dummy"})
    rules(psa={"name": "cache"}, repositioning={"name": "cache"})
