"""ROA rules in small situations, the answers worked out by hand."""

from __future__ import annotations

import pytest
from assigning import send as decide
from doubles import Situation, small_layout

from rmfs.control.roa.random import RandomStation
from rmfs.control.roa.same_pod import SamePod


@pytest.fixture
def situation() -> Situation:
    """Stations 1 (x = 5) and 2 (x = 15) with 20 space units each; pod k at x = k."""
    return Situation(
        small_layout(places=20, pods=16, replenishment_stations=2, station_capacity=20.0)
    )


def released(situation: Situation, pod: int, *units: int) -> None:
    for count in units:
        situation.world.promise(situation.bundle(units=count), pod)
    situation.world.release_bundles(pod)


def test_a_batch_goes_to_the_nearest_station(situation) -> None:
    """Pod 3 is nearer to x = 5, pod 15 nearer to x = 15; pod 10 is as near to both: the first."""
    released(situation, 3, 4, 4)
    released(situation, 15, 4)
    released(situation, 10, 4)
    made = decide(situation, situation.make(SamePod))
    assert made == [(0, 1), (1, 1), (2, 2), (3, 1)]


def test_a_batch_stays_together(situation) -> None:
    """Station 1 has 20, the batch of pod 4 takes 12: the batch of pod 3 (12) goes to station 2."""
    released(situation, 4, 12)
    released(situation, 3, 6, 6)
    assert decide(situation, situation.make(SamePod)) == [(0, 1), (1, 2), (2, 2)]


def test_first_come_first_served_holds_up_what_comes_after(situation) -> None:
    """Each station has 8 left; the batch of 10 fits nowhere, and the one of 4 waits behind it."""
    released(situation, 4, 12)
    released(situation, 14, 12)
    released(situation, 5, 10)
    released(situation, 6, 4)
    assert decide(situation, situation.make(SamePod)) == [(0, 1), (1, 2)]
    made = decide(situation, situation.make(SamePod, first_come_first_served=False))
    assert made == [(3, 1)]


def test_a_switched_off_station_gets_nothing(situation) -> None:
    situation.world.stations[1].active = False
    released(situation, 3, 4)
    assert decide(situation, situation.make(SamePod)) == [(0, 2)]


def test_a_batch_larger_than_any_station_is_split(situation) -> None:
    """24 do not fit into 20: two bundles of 8 go first; the third is a batch of its own then."""
    released(situation, 3, 8, 8, 8)
    controller = situation.make(SamePod)
    assert decide(situation, controller) == [(0, 1), (1, 1)]
    assert decide(situation, controller) == [(2, 2)]


def test_bundles_that_are_held_back_are_not_touched(situation) -> None:
    situation.world.promise(situation.bundle(), 3)
    assert decide(situation, situation.make(SamePod)) == []


def test_random_does_not_wait_for_the_pod(situation) -> None:
    situation.bundle()
    ((bundle, station),) = decide(situation, situation.make(RandomStation))
    assert bundle == 0
    assert station in (1, 2)


def test_random_chooses_among_stations_with_room(situation) -> None:
    """16 into one of them: the next 16 go to the other, and the third bundle has to wait."""
    for _ in range(3):
        situation.bundle(units=16)
    made = decide(situation, situation.make(RandomStation))
    assert sorted(station for _, station in made) == [1, 2]
    situation.bundle(units=4)
    assert [bundle for bundle, _ in decide(situation, situation.make(RandomStation))] == [3]


def test_random_sticks_to_a_station_while_it_has_room(situation) -> None:
    for _ in range(6):
        situation.bundle(units=4)
    stations = [station for _, station in decide(situation, situation.make(RandomStation))]
    assert len(set(stations[:5])) == 1
    assert stations[5] != stations[0]


def test_random_without_sticking_uses_both(situation) -> None:
    for _ in range(10):
        situation.bundle(units=4)
    made = decide(situation, situation.make(RandomStation, stick_to_station=False))
    assert sorted(station for _, station in made) == [1] * 5 + [2] * 5
