"""TA balanced in small situations, the answers worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from answers import Answers, decide
from doubles import Situation, small_layout

from rmfs.control.decisions import BringForBundles, BringForPicks, Park, Reposition, Rest
from rmfs.control.repositioning import Move
from rmfs.control.ta.balance import deal, reassign, split
from rmfs.control.ta.balanced import Balanced


class TestNumbers:
    def test_the_rest_goes_to_the_smaller_group(self) -> None:
        """16 robots by 2 : 1 are 10.7 and 5.3: 10 and 5, the one left to the 5."""
        assert split(16, 2, 1) == (10, 6)
        assert split(16, 1, 2) == (6, 10)

    def test_ties_go_to_the_first_group(self) -> None:
        assert split(5, 1, 1) == (3, 2)

    def test_a_group_without_weight_gets_nobody(self) -> None:
        assert split(5, 0, 1) == (0, 5)
        assert split(5, 1, 0) == (5, 0)
        assert split(5, 0, 0) == (0, 0)

    def test_shares_that_are_whole_numbers_stay_as_they_are(self) -> None:
        """Thirty robots by 1 : 2 are 10 and 20, also with weights 0.1 and 0.2."""
        assert split(30, 0.1, 0.2) == (10, 20)
        for robots in range(0, 200, 10):
            for tenths in range(11):
                first = robots * tenths // 10
                assert split(robots, tenths / 10, 1 - tenths / 10) == (first, robots - first)

    def test_one_of_three_stations_with_work(self) -> None:
        """Weights 2 and 1, but only one of three replenishment stations has work: 6 : 1."""
        assert split(35, 2.0, 1 / 3) == (30, 5)

    def test_stations_are_served_in_turn_up_to_the_limit(self) -> None:
        """Seven robots for three stations with a limit of two: one is left."""
        goals = dict.fromkeys((4, 2, 3), 0)
        assert deal(4, [4, 2, 3], 2, goals) == 0
        assert goals == {4: 2, 2: 1, 3: 1}
        assert deal(3, [4, 2, 3], 2, goals) == 1
        assert goals == {4: 2, 2: 2, 3: 2}

    def test_the_nearest_robots_are_moved(self) -> None:
        """Goals: two robots at station 0, one at station 1. Robots 0, 1 and 2 all have none.

        Distances to station 0: 5, 1, 9; to station 1: 2, 3, 4. Robot 1 goes to 0 (1), robot 0 to 1
        (2), and robot 2 to 0.
        """
        distance = np.array([[5.0, 2.0], [1.0, 3.0], [9.0, 4.0]])
        assert reassign([-1, -1, -1], {0: 2, 1: 1}, distance) == [1, 0, 0]

    def test_a_station_gives_up_only_what_it_has_too_many(self) -> None:
        """Station 0 has three robots and may keep two: the one nearest to station 1 goes there."""
        distance = np.array([[0.0, 9.0], [0.0, 2.0], [0.0, 3.0]])
        assert reassign([0, 0, 0], {0: 2, 1: 2}, distance) == [0, 1, 0]

    def test_robots_beyond_all_goals_have_no_station(self) -> None:
        distance = np.zeros((3, 2))
        assert reassign([0, 0, 0], {0: 1}, distance) == [0, -1, -1]
        assert reassign([0, 1, 1], {}, distance) == [-1, -1, -1]


@pytest.fixture
def situation() -> Situation:
    """One pick station (0), one replenishment station (1), three robots, pods at x = 0 to 3."""
    return Situation(small_layout(places=8, pods=4, robots=3, pick_stations=1))


def balanced(situation: Situation, stations: list[int], **parameters) -> Balanced:
    """Make the controller and say which robot works for which station."""
    controller = situation.make(Balanced, **parameters)
    controller._station_of = list(stations)
    return controller


def test_robots_are_divided_by_weight_at_the_start(situation) -> None:
    """Three robots by 2 : 1 are two and one. Replenishment (5, 10), pick (0, 10), robots at (i, 2).

    The pick station takes the nearest two, robots 0 and 1; the other robot 2.
    """
    assert situation.make(Balanced)._station_of == [0, 0, 1]


def test_an_empty_robot_gets_the_pod_that_pps_chooses(situation) -> None:
    situation.stock(2, s0=1)
    situation.assigned(s0=1)
    controller = balanced(situation, [0, -1, -1])
    made = decide(situation, controller, Answers(pods={0: 2}))
    assert made[0] == BringForPicks(situation.world.robots[0], 2, 0)


def test_a_robot_without_work_rests_beneath_the_pod_nearest_to_the_middle(situation) -> None:
    """The middle of the tier is (10, 6): the pods at x = 3, 2 and 1 are nearest, in this order."""
    made = decide(situation, balanced(situation, [0, 0, 1]), Answers())
    assert [(decision.robot.index, decision.place) for decision in made] == [(0, 3), (1, 2), (2, 1)]


def test_pps_is_not_asked_for_a_station_without_open_work(situation) -> None:
    answers = Answers()
    decide(situation, balanced(situation, [0, 0, 1]), answers)
    assert answers.asked == []


def test_pps_is_asked_once_for_each_change(situation) -> None:
    """Order 0 is open, but no pod has its SKU: the second robot of the station need not ask."""
    situation.assigned(s0=1)
    answers = Answers()
    controller = balanced(situation, [0, 0, 1])
    decide(situation, controller, answers)
    assert answers.asked == [("pod", 0, 0)]
    decide(situation, controller, answers)
    assert len(answers.asked) == 1
    situation.assigned(s0=1)
    decide(situation, controller, answers)
    assert answers.asked[1:] == [("pod", 0, 0)]


def test_a_resting_robot_is_given_work_that_appears(situation) -> None:
    controller = balanced(situation, [0, -1, -1])
    decide(situation, controller, Answers())
    situation.stock(0, s0=1)
    situation.assigned(s0=1)
    made = decide(situation, controller, Answers(pods={0: 0}))
    assert made == [BringForPicks(situation.world.robots[0], 0, 0)]


def test_an_idle_robot_beneath_the_pod_gets_the_job(situation) -> None:
    """Robot 1 rests beneath pod 3 and has no station; robot 0 asks, and PPS says pod 3."""
    controller = balanced(situation, [-1, -1, -1])
    world = situation.world
    world.start_rest(world.robots[1], 3)
    world.robots[1].waypoint = 3
    controller._station_of = [0, -1, -1]
    situation.stock(3, s0=1)
    situation.assigned(s0=1)
    made = decide(situation, controller, Answers(pods={0: 3}))
    assert made[0] == BringForPicks(world.robots[1], 3, 0)
    assert isinstance(made[1], Rest)
    assert made[1].robot is world.robots[0]
    assert controller._station_of == [-1, 0, -1]


class TestWithPod:
    @pytest.fixture
    def served(self, situation) -> Situation:
        """Robot 0 stands at station 0 with pod 1; its task is over."""
        situation.stock(1, s0=5, s1=5)
        situation.carry(robot=0, pod=1)
        situation.world.end_task(situation.world.robots[0])
        for robot in situation.world.robots[1:]:
            situation.world.start_rest(robot, robot.waypoint)
        return situation

    def test_it_goes_on_as_long_as_the_pod_is_of_use(self, served) -> None:
        served.assigned(s1=2)
        made = decide(served, balanced(served, [0, -1, -1]), Answers())
        assert made == [BringForPicks(served.world.robots[0], 1, 0)]

    def test_then_the_pod_is_parked_where_psa_says(self, served) -> None:
        served.assigned(s2=2)
        made = decide(served, balanced(served, [0, -1, -1]), Answers(place=6))
        assert made == [Park(served.world.robots[0], 6)]

    def test_bundles_at_its_replenishment_station_count_as_well(self, served) -> None:
        served.waiting_bundle(pod=1, station=1)
        made = decide(served, balanced(served, [1, -1, -1]), Answers())
        assert made == [BringForBundles(served.world.robots[0], 1, 1)]

    def test_another_station_near_by_if_so_wished(self, served) -> None:
        """The replenishment station is 5 m away and waits with a bundle for the pod."""
        served.waiting_bundle(pod=1, station=1)
        answers = Answers(place=6, next_station=1)
        near = balanced(served, [0, -1, -1], other_stations=True, search_radius_m=5.0)
        assert decide(served, near, answers) == [BringForBundles(served.world.robots[0], 1, 1)]
        assert answers.asked == [("station", 0, (1,))]

    def test_but_not_farther_away(self, served) -> None:
        served.waiting_bundle(pod=1, station=1)
        near = balanced(served, [0, -1, -1], other_stations=True, search_radius_m=4.9)
        made = decide(served, near, Answers(place=6, next_station=1))
        assert made == [Park(served.world.robots[0], 6)]

    def test_without_an_empty_place_it_waits(self, served) -> None:
        assert decide(served, balanced(served, [0, -1, -1]), Answers(place=-1)) == []
        assert 0 in served.world.asking

    def test_the_robot_that_asks_does_not_count_towards_the_limit(self, served) -> None:
        """Limit 1, and robot 0 is the one that works for the station (RAWSim-O refuses it)."""
        controller = balanced(served, [0, 0, -1], robots_per_station=1)
        served.assigned(s1=1)
        decide(served, controller, Answers())
        served.world.robots[0].task.picks.clear()
        assert controller._workers[0] == 1
        assert controller.may_work(served.world.robots[0], 0)
        assert not controller.may_work(served.world.robots[1], 0)


class TestBalancing:
    def test_every_30_s_robots_go_where_the_work_is(self, situation) -> None:
        """From 30 s on only the replenishment station has work, and all robots are sent there."""
        controller = situation.make(Balanced)
        situation.waiting_bundle(pod=1, station=1)
        situation.world.now_s = 29.0
        decide(situation, controller, Answers())
        assert controller._station_of == [0, 0, 1]
        assert controller.next_event_s() == 30.0
        situation.world.now_s = 30.0
        decide(situation, controller, Answers())
        assert controller._station_of == [1, 1, 1]
        assert controller.next_event_s() == 60.0

    def test_the_limit_leaves_robots_without_station(self, situation) -> None:
        """At most one robot for each of two stations: the third has none."""
        controller = situation.make(Balanced, robots_per_station=1)
        assert sorted(controller._station_of) == [-1, 0, 1]

    def test_some_robots_may_be_set_aside(self, situation) -> None:
        """2 + 1 of 6 parts work for stations: ceil(3/6 x 3) = 2 robots."""
        controller = situation.make(Balanced, reposition_weight=3.0)
        assert sorted(controller._station_of) == [-1, 0, 1]

    def test_never_if_the_period_is_0(self, situation) -> None:
        assert situation.make(Balanced, period_s=0).next_event_s() == float("inf")

    def test_robots_without_a_station_are_rounded_down_exactly(self) -> None:
        """With weights in hundredths; the share of repositioning, times the number of robots."""
        for robots in (20, 30):
            situation = Situation(small_layout(robots=robots))
            for pick, replenishment, moves in ((30, 25, 45), (5, 5, 50), (5, 0, 25), (70, 20, 10)):
                rule = situation.make(
                    Balanced,
                    pick_weight=pick / 100,
                    replenishment_weight=replenishment / 100,
                    reposition_weight=moves / 100,
                    robots_per_station=robots,
                )
                without = robots * moves // (pick + replenishment + moves)
                assert rule._station_of.count(-1) == without


class TestSearchAll:
    """Pick stations 0 and 1 at x = 0 and 10, replenishment station 2 at x = 5."""

    @pytest.fixture
    def two(self) -> Situation:
        return Situation(small_layout(places=8, pods=4, robots=2, pick_stations=2))

    def test_stations_the_nearest_first(self, two) -> None:
        """Robot 1 belongs to station 1 and stands at (1, 2): nearest are 0, 2, 1."""
        controller = balanced(two, [0, 1], search_all=True)
        assert list(controller.stations_for(two.world.robots[1])) == [0, 2, 1]
        assert list(balanced(two, [0, 1]).stations_for(two.world.robots[1])) == [1]

    def test_a_robot_takes_work_of_another_station(self, two) -> None:
        two.stock(2, s0=1)
        two.assigned(station=0, s0=1)
        made = decide(two, balanced(two, [1, 1], search_all=True), Answers(pods={0: 2}))
        assert made[0] == BringForPicks(two.world.robots[0], 2, 0)
        assert isinstance(made[1], Rest)

    def test_a_pod_is_tried_at_all_stations_before_it_is_parked(self, two) -> None:
        """There is nothing for it at station 0 (where RAWSim-O would park it), but at 1."""
        two.stock(1, s0=5)
        two.carry(robot=0, pod=1)
        two.world.end_task(two.world.robots[0])
        two.assigned(station=1, s0=1)
        made = decide(two, balanced(two, [0, -1], search_all=True), Answers())
        assert BringForPicks(two.world.robots[0], 1, 1) in made

    def test_a_robot_without_station_has_none(self, two) -> None:
        controller = balanced(two, [-1, -1], search_all=True)
        assert list(controller.stations_for(two.world.robots[0])) == []


class TestRepositioning:
    def test_instead_of_resting(self, situation) -> None:
        made = decide(situation, balanced(situation, [0, 0, 1]), Answers(moves=[Move(2, 6)]))
        assert made[0] == Reposition(situation.world.robots[0], 2, 6)
        assert [type(decision) for decision in made[1:]] == [Rest, Rest]

    def test_work_of_the_station_comes_first(self, situation) -> None:
        situation.stock(1, s0=1)
        situation.assigned(s0=1)
        answers = Answers(pods={0: 1}, moves=[Move(2, 6)])
        made = decide(situation, balanced(situation, [0, -1, -1]), answers)
        assert made[0] == BringForPicks(situation.world.robots[0], 1, 0)
        assert made[1] == Reposition(situation.world.robots[1], 2, 6)

    def test_a_robot_at_rest_is_asked_again(self, situation) -> None:
        controller = balanced(situation, [0, 0, 1])
        decide(situation, controller, Answers())
        made = decide(situation, controller, Answers(moves=[Move(2, 6)]))
        assert [(type(task), task.robot.index) for task in made] == [(Reposition, 1)]

    def test_the_robot_beneath_the_pod_moves_it(self, situation) -> None:
        """Robot 1 rests beneath pod 3, which robot 0 was to move."""
        world = situation.world
        world.start_rest(world.robots[1], 3)
        world.robots[1].waypoint = 3
        made = decide(situation, balanced(situation, [0, 0, 1]), Answers(moves=[Move(3, 6)]))
        assert made[0] == Reposition(world.robots[1], 3, 6)
        assert isinstance(made[1], Rest)

    def test_only_robots_set_aside_for_it(self, situation) -> None:
        """With a weight of 3 of 6 one robot has no station; only that one moves pods."""
        controller = situation.make(Balanced, reposition_weight=3.0, reposition_before_rest=False)
        aside = controller._station_of.index(-1)
        moves = [Move(0, 7), Move(1, 6), Move(2, 5)]
        made = decide(situation, controller, Answers(moves=moves))
        moved = [task.robot.index for task in made if isinstance(task, Reposition)]
        assert moved == [aside]

    def test_not_if_not_wished(self, situation) -> None:
        controller = situation.make(Balanced, reposition_before_rest=False)
        made = decide(situation, controller, Answers(moves=[Move(2, 6)]))
        assert all(isinstance(task, Rest) for task in made)


class TestInstalledLater:
    def test_robots_at_work_count_towards_the_limits(self, situation) -> None:
        """Robot 0 works for station 0 when the rule is installed: with a limit of 1 nobody else
        may."""
        situation.stock(1, s0=1)
        situation.assigned(s0=1)
        situation.world.start_pick(situation.world.robots[0], 1, 0)
        controller = situation.make(Balanced, robots_per_station=1)
        assert not controller.may_work(situation.world.robots[1], 0)
        assert controller.may_work(situation.world.robots[0], 0)


@pytest.mark.parametrize(("rule", "places"), [("middle", [3, 2]), ("nearest", [0, 1])])
def test_rest_places(situation, rule, places) -> None:
    """Pods at x = 0 to 3, middle at x = 10; robots at (0, 2) and (1, 2), so nearest are 0 and 1."""
    made = decide(situation, balanced(situation, [-1, -1, -1], rest=rule), Answers())
    assert [decision.place for decision in made[:2]] == places


def test_rest_at_random_on_the_own_tier(situation) -> None:
    rule = situation.make(Balanced, rest="random")
    assert {rule.rest_place(situation.world.robots[0]) for _ in range(60)} == {0, 1, 2, 3}
