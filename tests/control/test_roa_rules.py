"""ROA same-pod with other station rules and with broken batches, answers worked out by hand."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from assigning import send as decide
from doubles import Situation, small_layout

from rmfs.control.roa.same_pod import SamePod
from rmfs.layout.model import Tier


def released(situation: Situation, pod: int, *units: int) -> None:
    for count in units:
        situation.world.promise(situation.bundle(units=count), pod)
    situation.world.release_bundles(pod)


def situation_with(stations: int = 3, **layout) -> Situation:
    """Stations 1, 2, 3 at x = 5, 15, 25 with 20 space units each; pod k at x = k."""
    given = {"places": 30, "pods": 26, "station_capacity": 20.0} | layout
    return Situation(small_layout(replenishment_stations=stations, **given))


@pytest.fixture
def situation() -> Situation:
    """Station 1 has two bundles of 3, station 2 one of 8, station 3 none."""
    made = situation_with()
    for station, units in ((1, 3), (1, 3), (2, 8)):
        made.world.choose_station(made.bundle(units=units), station)
    return made


class TestStationRules:
    @pytest.mark.parametrize(
        ("rule", "station"),
        [("emptiest", 3), ("fullest", 2), ("least-busy", 3), ("most-busy", 1), ("nearest", 1)],
    )
    def test_a_batch_of_four_at_pod_0(self, situation, rule, station) -> None:
        """Used: 6, 8 and 0 of 20. Bundles: 2, 1 and 0. Pod 0 is nearest to x = 5."""
        released(situation, 0, 4)
        assert decide(situation, situation.make(SamePod, station=rule)) == [(3, station)]

    def test_only_stations_with_room_for_all_of_it(self, situation) -> None:
        """Station 2 has 12 left; 14 fit into station 1 (14 left, 6 used) and 3: fullest is 1."""
        released(situation, 0, 14)
        assert decide(situation, situation.make(SamePod, station="fullest")) == [(3, 1)]

    def test_ties_go_to_the_first_station(self) -> None:
        for rule in ("emptiest", "fullest", "least-busy", "most-busy"):
            situation = situation_with()
            released(situation, 25, 4)
            assert decide(situation, situation.make(SamePod, station=rule)) == [(0, 1)]

    def test_random_reaches_all_with_room(self, situation) -> None:
        """13 do not fit into station 2."""
        released(situation, 0, 13)
        controller = situation.make(SamePod, station="random")
        assert {next(controller.decide()).station for _ in range(50)} == {1, 3}

    def test_a_bundle_counts_until_it_is_stored(self, situation) -> None:
        """When station 2's bundle has gone into its pod, it is the one with fewest bundles."""
        world = situation.world
        bundle = world.bundles.bundles[2]
        world.promise(bundle, 9)
        world.release_bundles(9)
        task = world.start_replenish(world.robots[0], 9, 2)
        released(situation, 0, 20)
        assert decide(situation, situation.make(SamePod)) == [(3, 3)]
        world.store_bundle(task)
        assert [station.bundles for station in world.replenishment_stations] == [2, 0, 1]


class TestBrokenBatches:
    def rule(self, situation: Situation, **parameters):
        return situation.make(SamePod, break_batches=True, **parameters)

    def test_bundles_go_on_to_the_next_station_when_the_first_is_full(self) -> None:
        """Pod 0, four bundles of 8: two fit into station 1 (x = 5), which is nearest to the pod.

        The next station is the one nearest to it: station 2 (x = 15), then station 2 again.
        """
        situation = situation_with()
        released(situation, 0, 8, 8, 8, 8)
        made = decide(situation, self.rule(situation))
        assert made == [(0, 1), (1, 1), (2, 2), (3, 2)]

    def test_a_later_bundle_goes_to_the_station_of_the_last(self) -> None:
        """Pod 12 is nearest to station 2; its next bundle goes there too, although it is fuller."""
        situation = situation_with()
        controller = self.rule(situation, station="emptiest")
        situation.world.choose_station(situation.bundle(units=4), 1)
        released(situation, 12, 4)
        assert decide(situation, controller) == [(1, 2)]
        situation.world.choose_station(situation.bundle(units=8), 2)
        released(situation, 12, 4)
        assert decide(situation, controller) == [(3, 2)]

    def test_not_if_that_station_was_switched_off(self) -> None:
        """From station 2 it is as far to station 1 as to station 3: the first."""
        situation = situation_with()
        controller = self.rule(situation)
        released(situation, 15, 4)
        assert decide(situation, controller) == [(0, 2)]
        situation.world.stations[2].active = False
        released(situation, 15, 4)
        assert decide(situation, controller) == [(1, 1)]

    def test_what_fits_nowhere_waits_and_holds_up_nobody(self) -> None:
        """One station of 20: of 15, 10 and 5 the second waits, of this pod and of others."""
        situation = situation_with(stations=1)
        released(situation, 3, 15, 10, 5)
        released(situation, 4, 1)
        assert decide(situation, self.rule(situation)) == [(0, 1), (2, 1)]
        assert list(situation.world.bundles.released) == [3, 4]


def test_stations_on_other_tiers() -> None:
    """Pod 0 is on tier 0, the only station with room on tier 1: it gets the batch if allowed."""
    layout = small_layout(places=6, pods=4, replenishment_stations=1)
    tier = np.zeros(layout.waypoints, np.int16)
    tier[layout.replenishment_stations[0].waypoint] = 1
    floors = (Tier(length_m=20.0, width_m=12.0), Tier(length_m=20.0, width_m=12.0))
    situation = Situation(dataclasses.replace(layout, tier=tier, tiers=floors))
    released(situation, 0, 4)
    assert decide(situation, situation.make(SamePod)) == []
    assert decide(situation, situation.make(SamePod, same_tier=False)) == [(0, 1)]


def test_a_pod_whose_tier_has_no_station_that_is_on_holds_up_nobody() -> None:
    """Pod 0 and station 2 are on tier 1, pod 1 and station 1 on tier 0."""
    layout = small_layout(places=6, pods=4, replenishment_stations=2)
    tier = np.zeros(layout.waypoints, np.int16)
    tier[[layout.pod_waypoint[0], layout.replenishment_stations[1].waypoint]] = 1
    floors = (Tier(length_m=20.0, width_m=12.0), Tier(length_m=20.0, width_m=12.0))
    situation = Situation(dataclasses.replace(layout, tier=tier, tiers=floors))
    situation.world.stations[2].active = False
    for pod in (0, 1):
        released(situation, pod, 4)
    controller = situation.make(SamePod)
    assert decide(situation, controller) == [(1, 1)]
    situation.world.stations[2].active = True
    assert decide(situation, controller) == [(0, 2)]
