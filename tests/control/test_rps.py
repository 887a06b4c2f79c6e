"""RPS rules and their buffer in small situations, the answers worked out by hand."""

from __future__ import annotations

from math import inf

import pytest
from assigning import promise as decide
from doubles import Situation, small_layout

from rmfs.control.problems import Trigger
from rmfs.control.rps.emptiest import Emptiest
from rmfs.control.rps.random import RandomPod


@pytest.fixture
def situation() -> Situation:
    """Four pods of 100 space units, holding 30, 10, 10 and 50."""
    made = Situation(small_layout(pods=4))
    for pod, units in enumerate((30, 10, 10, 50)):
        made.stock(pod, s0=units)
    return made


def test_emptiest_takes_the_least_loaded_pod_and_the_first_of_equals(situation) -> None:
    """Pods 1 and 2 hold 10 each; pod 1 is first."""
    situation.bundle()
    assert decide(situation, situation.make(Emptiest)) == [("promise", 0, 1)]


def test_promises_count_as_load(situation) -> None:
    """Without stickiness: pod 1 (10 -> 14), pod 2 (10 -> 14), pod 1 again."""
    for _ in range(3):
        situation.bundle()
    made = decide(situation, situation.make(Emptiest, stick_to_pod=False))
    assert [pod for _, _, pod in made] == [1, 2, 1]


def test_it_sticks_to_a_pod_until_a_station_serves_it(situation) -> None:
    controller = situation.make(Emptiest)
    for _ in range(2):
        situation.bundle()
    assert [pod for _, _, pod in decide(situation, controller)] == [1, 1]
    stored = situation.bundle()
    stored.pod = 1
    controller.hear(Trigger.BUNDLE_STORED, stored)
    stored.pod = -1
    assert decide(situation, controller) == [("promise", 2, 2)]


def test_it_leaves_the_pod_when_the_bundle_does_not_fit(situation) -> None:
    """60 and 60 do not both fit into 90."""
    for _ in range(2):
        situation.bundle(units=60)
    made = decide(situation, situation.make(Emptiest))
    assert made == [("promise", 0, 1), ("promise", 1, 2)]


def test_a_bundle_for_which_no_pod_has_room_waits_and_the_next_does_not(situation) -> None:
    situation.bundle(units=95)
    situation.bundle(units=5)
    assert decide(situation, situation.make(Emptiest)) == [("promise", 1, 1)]
    assert list(situation.world.bundles.without_pod) == [0]


def test_a_pod_is_released_at_the_threshold(situation) -> None:
    """10 + 35 = 45, 80: the second bundle reaches 80 % and releases both."""
    for _ in range(2):
        situation.bundle(units=35)
    made = decide(situation, situation.make(Emptiest))
    assert made == [("promise", 0, 1), ("promise", 1, 1), ("release", 1)]
    assert [bundle.index for bundle in situation.world.bundles.released[1]] == [0, 1]


@pytest.mark.parametrize("percent", range(11, 100))
def test_exactly_at_the_threshold_whatever_the_share(situation, percent) -> None:
    """Pod 1 holds 10 of 100 units; one unit less than the threshold is not enough."""
    for units, released in ((percent - 11, False), (1, True)):
        if units:
            situation.bundle(units=units)
        rule = situation.make(Emptiest, buffer_threshold=percent / 100)
        rule._last = 1
        made = decide(situation, rule)
        assert (("release", 1) in made) == released


def test_a_pod_is_released_when_its_time_is_up(situation) -> None:
    """Promises at 0 and 100 s: the time-out of 1200 s runs from the second."""
    controller = situation.make(Emptiest)
    situation.bundle()
    decide(situation, controller)
    assert controller.next_event_s() == 1200.0
    situation.world.now_s = 100.0
    situation.bundle()
    decide(situation, controller)
    assert controller.next_event_s() == 1300.0
    situation.world.now_s = 1299.0
    assert decide(situation, controller) == []
    situation.world.now_s = 1300.0
    assert decide(situation, controller) == [("release", 1)]
    assert controller.next_event_s() == inf


def test_a_new_rule_releases_what_another_held_back(situation) -> None:
    """Pod 1 has 10 + 35, pod 3 has 50 + 4 of 100; the new threshold is a half."""
    for pod, units in ((1, 35), (3, 4)):
        situation.world.promise(situation.bundle(units=units), pod)
    controller = situation.make(RandomPod, buffer_threshold=0.5)
    assert decide(situation, controller) == [("release", 3)]
    situation.world.now_s = 1200.0
    assert decide(situation, controller) == [("release", 1)]


def test_random_takes_any_pod_with_room(situation) -> None:
    """95 space units fit nowhere, 75 into pods 1 and 2 only."""
    controller = situation.make(RandomPod, stick_to_pod=False)
    assert controller.choose(situation.bundle(units=95)) == -1
    bundle = situation.bundle(units=75)
    assert {controller.choose(bundle) for _ in range(50)} == {1, 2}


def test_random_sticks_to_its_pod(situation) -> None:
    controller = situation.make(RandomPod)
    for _ in range(5):
        situation.bundle(units=1)
    pods = [pod for _, _, pod in decide(situation, controller)]
    assert len(set(pods)) == 1
