"""SA rules in small situations, the answers worked out by hand."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import ClassVar

import pytest
from doubles import Situation, small_layout

from rmfs.control.sa.all import AllStations
from rmfs.control.sa.backlog_threshold import BacklogThreshold
from rmfs.control.sa.constant_ratio import ConstantRatio
from rmfs.control.sa.work_shifts import WorkShifts

HOUR = 3600.0


@pytest.fixture
def situation() -> Situation:
    """Pick stations 0 to 3 with the activation numbers 4, 3, 2, 1; replenishment stations 4 to 7
    with 1 each. All are off."""
    plan = small_layout(pick_stations=4, replenishment_stations=4)
    picks = [
        replace(station, activation=4 - number) for number, station in enumerate(plan.pick_stations)
    ]
    made = Situation(replace(plan, pick_stations=tuple(picks)))
    for station in made.world.stations:
        station.active = False
    return made


def decide(situation: Situation, rule) -> list[tuple[int, bool]]:
    """Apply all decisions."""
    made = []
    for station, active in rule.decide():
        situation.world.stations[station].active = active
        made.append((station, active))
    return made


def active(situation: Situation) -> list[int]:
    return [station.index for station in situation.world.stations if station.active]


def test_all(situation) -> None:
    decide(situation, situation.make(AllStations))
    assert active(situation) == list(range(8))


class TestConstantRatio:
    @pytest.mark.parametrize(
        ("active_share", "pick_share", "expected"),
        [
            (0.5, 0.5, [2, 3, 4, 5]),  # floor(8 x 0.5) = 4, of them 2 and 2
            (0.7, 0.5, [2, 3, 4, 5, 6]),  # floor(5.6) = 5, floor(2.5) = 2 and 3
            (1.0, 0.5, [0, 1, 2, 3, 4, 5, 6, 7]),
            (0.5, 0.0, [3, 4, 5, 6, 7]),  # at least one pick station
            (0.0, 0.0, [3, 4]),
        ],
    )
    def test_those_with_the_lowest_activation_numbers(
        self, situation, active_share, pick_share, expected
    ) -> None:
        rule = situation.make(ConstantRatio, active_share=active_share, pick_share=pick_share)
        decide(situation, rule)
        assert active(situation) == expected

    def test_installed_later_it_switches_the_others_off(self, situation) -> None:
        decide(situation, situation.make(AllStations))
        decide(situation, situation.make(ConstantRatio))
        assert active(situation) == [2, 3, 4, 5]


class TestWorkShifts:
    def test_the_default_day(self, situation) -> None:
        """Off from 0 h, on from 6 h, off from 22 h, and again the next day."""
        rule = situation.make(WorkShifts)
        for hour, on, change in (
            (0, [], 6),
            (5.99, [], 6),
            (6, list(range(8)), 22),
            (22, [], 30),
            (29, [], 30),
            (30, list(range(8)), 46),
        ):
            situation.world.now_s = hour * HOUR
            decide(situation, rule)
            assert active(situation) == on
            assert rule.next_event_s() == change * HOUR

    def test_the_clock_is_that_of_the_scenario(self, situation) -> None:
        """At time zero it is 5 h: an hour later they are on, until 17 h after time zero."""
        situation.view.time_of_day_s = 5 * HOUR
        rule = situation.make(WorkShifts)
        for now_h, on, change in ((0, [], 1), (1, list(range(8)), 17), (17, [], 25)):
            situation.world.now_s = now_h * HOUR
            decide(situation, rule)
            assert active(situation) == on
            assert rule.next_event_s() == change * HOUR

    def test_a_shift_that_changes_nothing_is_no_event(self, situation) -> None:
        """Off at 0 and at 5, on at 10 of 20 s: the change after 0 is at 10, after 10 at 20."""
        shifts = ({"at_s": 0, "on": False}, {"at_s": 5, "on": False}, {"at_s": 10, "on": True})
        rule = situation.make(WorkShifts, shifts=shifts, loop_s=20)
        assert rule.next_event_s() == 10.0
        situation.world.now_s = 10.0
        assert rule.next_event_s() == 20.0

    def test_always_on(self, situation) -> None:
        rule = situation.make(WorkShifts, shifts=({"at_s": 0, "on": True},))
        assert rule.next_event_s() == inf

    @pytest.mark.parametrize(
        ("parameters", "message"),
        [
            ({"shifts": ({"at_s": 1, "on": True},)}, "at_s = 0"),
            ({"shifts": ({"at_s": 0, "on": True}, {"at_s": 0, "on": False})}, "ascend"),
            ({"loop_s": 70000}, "end before loop_s"),
        ],
    )
    def test_mistakes(self, parameters, message) -> None:
        with pytest.raises(ValueError, match=message):
            WorkShifts.parameters_model(**parameters)


class TestBacklogThreshold:
    """A pause of 100 s; two waiting orders, or bundles, are tolerated. Stations have 4 slots."""

    PARAMETERS: ClassVar = {"pause_s": 100.0, "orders_on": 2, "bundles_on": 2}

    @pytest.fixture
    def rule(self, situation) -> BacklogThreshold:
        rule = situation.make(BacklogThreshold, **self.PARAMETERS)
        decide(situation, rule)
        assert active(situation) == list(range(8))
        assert rule.next_event_s() == 100.0
        return rule

    def test_little_used_stations_are_switched_off_the_last_first(self, situation, rule) -> None:
        """11 of 16 slots are less than 0.7, so the pick station with the highest activation number,
        0, is switched off; 11 of 12 are more. No bundles: the last one of its kind, 7."""
        for station, orders in ((1, 4), (2, 4), (3, 3)):
            for _ in range(orders):
                situation.assigned(station, s0=1)
        situation.world.now_s = 99.0
        assert decide(situation, rule) == []
        situation.world.now_s = 100.0
        assert decide(situation, rule) == [(0, False), (7, False)]
        situation.world.now_s = 199.0
        assert decide(situation, rule) == []
        situation.world.now_s = 200.0
        assert decide(situation, rule) == [(6, False)]

    def test_the_last_one_stays_on(self, situation, rule) -> None:
        for now_s in range(100, 1100, 100):
            situation.world.now_s = float(now_s)
            decide(situation, rule)
        assert active(situation) == [3, 4]

    def test_much_waiting_work_switches_on_the_first_that_is_off(self, situation, rule) -> None:
        """Stations 0 and 1 are off, the others full; three orders wait: 1 comes before 0."""
        for station in (0, 1):
            situation.world.stations[station].active = False
        for station in (2, 3):
            for _ in range(4):
                situation.assigned(station, s0=1)
        for _ in range(3):
            situation.order(s0=1)
        situation.world.now_s = 100.0
        assert (1, True) in decide(situation, rule)

    def test_both_or_neither(self, situation, rule) -> None:
        """Three orders wait, but no slot is used: nothing. One order waits, all slots are used:
        nothing. (RAWSim-O takes the share of slots for 0 there, and switches off.)"""
        for _ in range(3):
            situation.order(s0=1)
        situation.world.now_s = 100.0
        assert decide(situation, rule) == [(7, False)]
        for order in list(situation.world.orders)[:2]:
            situation.world.assign_order(order, 0)
        for station in range(4):
            while situation.world.pick_stations[station].free_slots:
                situation.assigned(station, s0=1)
        situation.world.now_s = 200.0
        assert decide(situation, rule) == [(6, False)]

    def test_bundles_in_buffers_count(self, situation, rule) -> None:
        """Station 7 is off, the others are full (a bundle of 1000 space units each); three bundles
        wait for RPS."""
        situation.world.stations[7].active = False
        for station in situation.world.replenishment_stations[:3]:
            station.used = station.capacity
        for pod in range(3):
            situation.world.promise(situation.bundle(), pod)
        situation.world.now_s = 100.0
        assert decide(situation, rule) == [(0, False), (7, True)]
