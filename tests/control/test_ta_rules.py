"""TA constant-ratio, random, brute-force and swarm in small situations, worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from answers import Answers, decide
from doubles import Situation, small_layout

from rmfs.control.decisions import BringForBundles, BringForPicks, Park, Prepare, Reposition, Rest
from rmfs.control.pps.random import RandomPod as Pps
from rmfs.control.repositioning import Move
from rmfs.control.ta.brute_force import BruteForce
from rmfs.control.ta.constant_ratio import ConstantRatio
from rmfs.control.ta.linear import Linear
from rmfs.control.ta.random import RandomTasks
from rmfs.control.ta.swarm import Swarm
from rmfs.control.trackers.congestion import Congestion


@pytest.fixture
def situation() -> Situation:
    """Pick station 0 at (0, 10), replenishment station 1 at (5, 10), pods at x = 0 to 3 of 8
    places.

    Robots 0 to 3 at (0, 2) to (3, 2); top speed 1 m/s; lifting takes 2 s.
    """
    return Situation(small_layout(places=8, pods=4, robots=4))


def served(situation: Situation, pod: int = 1) -> None:
    """Robot 0 stands at station 0 with a pod, its task is over; the others rest where they are."""
    situation.carry(robot=0, pod=pod)
    situation.world.end_task(situation.world.robots[0])
    for robot in situation.world.robots[1:]:
        situation.world.start_rest(robot, robot.waypoint)


class TestConstantRatio:
    def test_three_quarters_pick(self, situation) -> None:
        """floor(4 x 0.75) = 3 for the pick station. Nearest first: robots 0, 1, 2 at x = 0, 1, 2
        are 8, 8.06 and 8.25 m from (0, 10); robot 3 is 8.25 m from (5, 10) and taken after robot
        0."""
        controller = situation.make(ConstantRatio)
        assert controller._station_of == [0, 0, 0, 1]

    def test_half(self, situation) -> None:
        assert situation.make(ConstantRatio, pick_share=0.5)._station_of == [0, 0, 1, 1]

    def test_a_pod_is_used_again_before_it_is_parked(self, situation) -> None:
        """RAWSim-O would park it."""
        situation.stock(1, s0=5)
        served(situation)
        situation.assigned(s0=1)
        made = decide(situation, situation.make(ConstantRatio), Answers(place=6))
        assert made == [BringForPicks(situation.world.robots[0], 1, 0)]

    def test_stations_that_are_off_and_have_no_work_get_nobody(self, situation) -> None:
        """From 30 s on: station 0 is off, and stays in as long as its order is there."""
        controller = situation.make(ConstantRatio)
        situation.stock(0, s0=1)
        order = situation.assigned(s0=1)
        situation.world.stations[0].active = False
        situation.world.now_s = 30.0
        decide(situation, controller, Answers())
        assert controller._station_of == [0, 0, 0, 1]
        task = situation.world.start_pick(situation.world.robots[0], 0, 0)
        situation.world.pick_unit(task)
        situation.world.complete_order(order)
        situation.world.now_s = 60.0
        decide(situation, controller, Answers())
        assert sorted(controller._station_of) == [-1, -1, -1, 1]

    def test_if_all_are_off_nothing_changes(self, situation) -> None:
        controller = situation.make(ConstantRatio)
        for station in situation.world.stations:
            station.active = False
        situation.world.now_s = 30.0
        decide(situation, controller, Answers())
        assert controller._station_of == [0, 0, 0, 1]
        assert controller.next_event_s() == 60.0


class TestRandom:
    def random(self, situation, picks: bool = True, **parameters) -> RandomTasks:
        """Every robot looks for picks, or for bundles, and keeps to it."""
        given = {"switch_probability": 0.0, "reposition_probability": 0.0, **parameters}
        controller = situation.make(RandomTasks, **given)
        controller._picks = [picks] * len(situation.world.robots)
        return controller

    def test_any_pod_with_any_work(self) -> None:
        """Pods 1 and 2 have SKU 0, which both stations want; pod 3 has SKU 1, which station 1 does:
        the three are drawn alike, and for 1 and 2 then a station."""
        situation = Situation(small_layout(places=8, pods=4, robots=4, pick_stations=2))
        for pod, sku in ((1, "s0"), (2, "s0"), (3, "s1")):
            situation.stock(pod, **{sku: 9})
        situation.assigned(0, s0=1)
        situation.assigned(1, s0=1, s1=1)
        controller = self.random(situation)
        robot = situation.world.robots[0]
        drawn = [controller.work_for(robot, Answers()) for _ in range(600)]
        found = {(task.pod, task.station) for task in drawn}
        assert found == {(1, 0), (1, 1), (2, 0), (2, 1), (3, 1)}
        counts = np.bincount([task.pod for task in drawn], minlength=4)
        assert all(150 < count < 250 for count in counts[1:])

    def test_the_other_kind_of_work_if_allowed(self, situation) -> None:
        situation.waiting_bundle(pod=2, station=1)
        robot = situation.world.robots[0]
        task = self.random(situation).work_for(robot, Answers())
        assert task == BringForBundles(robot, 2, 1)
        assert self.random(situation, other_kind=False).work_for(robot, Answers()) is None

    def test_without_work_it_rests_anywhere(self, situation) -> None:
        made = decide(situation, self.random(situation), Answers())
        assert [type(task) for task in made] == [Rest] * 4
        assert {task.place for task in made} == {0, 1, 2, 3}

    def test_a_pod_is_kept_or_parked(self, situation) -> None:
        situation.stock(1, s0=5)
        served(situation)
        situation.assigned(s0=1)
        robot = situation.world.robots[0]
        controller = self.random(situation, keep_pod_probability=1.0)
        answers = Answers(place=6)
        answers.pps = situation.make(Pps)
        assert list(controller.task_for(robot, answers)) == [BringForPicks(robot, 1, 0)]
        controller = self.random(situation, keep_pod_probability=0.0)
        assert list(controller.task_for(robot, answers)) == [Park(robot, 6)]

    def test_it_asks_for_a_pod_to_move_and_then_looks_for_work(self, situation) -> None:
        """RAWSim-O leaves the robot without task if there is no pod to move."""
        situation.stock(1, s0=5)
        situation.assigned(s0=1)
        controller = self.random(situation, reposition_probability=1.0)
        made = decide(situation, controller, Answers(moves=[Move(3, 7)]))
        assert made[0] == Reposition(situation.world.robots[0], 3, 7)
        assert made[1] == BringForPicks(situation.world.robots[1], 1, 0)

    def test_it_changes_kind_now_and_then(self, situation) -> None:
        controller = self.random(situation, switch_probability=1.0)
        decide(situation, controller, Answers())
        assert controller._picks == [False] * 4

    def test_a_robot_at_rest_is_given_work_that_appears(self, situation) -> None:
        controller = self.random(situation)
        decide(situation, controller, Answers())
        situation.stock(2, s0=1)
        situation.assigned(s0=1)
        made = decide(situation, controller, Answers())
        assert [(task.pod, task.station) for task in made] == [(2, 0)]

    def test_a_robot_without_work_of_its_kind_does_not_stop_the_others(self, situation) -> None:
        """Robot 0 rests and takes picks only; robot 1 takes bundles, and one waits."""
        controller = self.random(situation, other_kind=False)
        controller._picks[1] = False
        for robot in situation.world.robots[:2]:
            situation.world.start_rest(robot, robot.waypoint)
        situation.waiting_bundle(pod=3, station=1)
        made = decide(situation, controller, Answers())
        assert BringForBundles(situation.world.robots[1], 3, 1) in made

    def test_robots_begin_by_the_share_of_pick_stations(self) -> None:
        """Three of four stations are pick stations: about 75 of 100 robots begin as pickers."""
        plan = small_layout(places=8, pods=4, robots=100, pick_stations=3)
        controller = Situation(plan).make(RandomTasks)
        assert 60 < sum(controller._picks) < 90


class TestBruteForce:
    def test_the_pair_that_is_served_soonest(self, situation) -> None:
        """Pods 1 and 3 have the SKU. Robot 0 (0, 2): to pod 1 sqrt(5) + 2, on 11 s: 15.2; to pod 3
        sqrt(13) + 2, on 13 s: 18.6."""
        for pod in (1, 3):
            situation.stock(pod, s0=9)
        situation.assigned(s0=1)
        job = situation.make(BruteForce)._best(situation.world.robots[0], Answers())
        assert job.pod == 1
        assert job.seconds == pytest.approx(5**0.5 + 2 + 11)

    def test_robots_under_way_make_a_station_less_attractive(self) -> None:
        """Both pick stations want SKU 0 of pod 1: 11 s to the one at x = 0, 19 s to the one at 10.
        With three robots under way to the first and 2 s per square of their number it is 18 s, with
        2.2 s it is 19.8 s."""
        situation = Situation(small_layout(places=8, pods=5, robots=4, pick_stations=2))
        for robot in range(3):
            situation.world.start_pick(situation.world.robots[robot], pod=2 + robot, station=0)
        situation.stock(1, s0=9)
        situation.assigned(0, s0=1)
        situation.assigned(1, s0=1)
        robot = situation.world.robots[3]
        near = situation.make(BruteForce, queue_cost_s=2.0)._best(robot, Answers())
        far = situation.make(BruteForce, queue_cost_s=2.2)._best(robot, Answers())
        assert (near.station, far.station) == (0, 1)

    def test_congestion_delays_the_carried_pod_like_any_other(self, monkeypatch) -> None:
        """Pod 1 is carried and the only one with work; on each trip, 50 s of delay are expected."""
        monkeypatch.setattr(Congestion, "on_trips", lambda *given: np.full(len(given[2]), 50.0))
        situation = Situation(small_layout(places=8, pods=4, robots=4))
        nothing = np.zeros(situation.view.layout.waypoints)
        situation.traffic.heat = lambda: {"visits": nothing, "waiting_s": nothing}
        served(situation)
        situation.stock(1, s0=5)
        situation.assigned(s0=1)
        robot = situation.world.robots[0]
        answers = Answers()
        answers.pps = situation.make(Pps)
        plain, careful = (
            situation.make(BruteForce, congestion=weight)._best(robot, answers)
            for weight in (0.0, 2.0)
        )
        assert plain.pod == careful.pod == 1
        assert careful.seconds == plain.seconds + 100.0

    def test_of_equal_stations_the_first(self) -> None:
        """Pod 5 is 15 s from the stations at x = 0 and 10, which both want its SKU: station 0. A
        robot under way to it makes the other one better."""
        situation = Situation(small_layout(places=8, pods=6, robots=2, pick_stations=2))
        situation.stock(5, s0=9)
        for station in (1, 0):
            situation.assigned(station, s0=1)
        robot = situation.world.robots[0]
        assert situation.make(BruteForce)._best(robot, Answers()).station == 0
        situation.world.start_pick(situation.world.robots[1], pod=4, station=0)
        assert situation.make(BruteForce, queue_cost_s=30.0)._best(robot, Answers()).station == 1

    def test_a_carried_pod_is_used_where_it_stands(self, situation) -> None:
        situation.stock(1, s0=9)
        served(situation)
        situation.assigned(s0=1)
        made = decide(situation, situation.make(BruteForce), Answers())
        assert made == [BringForPicks(situation.world.robots[0], 1, 0)]

    def test_it_is_parked_on_the_way_to_a_better_one(self, situation) -> None:
        """Pod 3 has the SKU. From (0, 10) to an empty place x takes 10 + x s, on to x = 3 it is
        |x - 3| s: for 1 it is 11 + 2, for 4 14 + 1, so the empty place 1. Then pod 3 is fetched."""
        situation.stock(3, s0=9)
        served(situation)
        situation.assigned(s0=1)
        robot = situation.world.robots[0]
        made = decide(situation, situation.make(BruteForce), Answers())
        assert made[:2] == [Park(robot, 1), Prepare(robot, (BringForPicks(robot, 3, 0),))]

    def test_without_work_it_is_parked_at_the_nearest_place(self, situation) -> None:
        served(situation)
        made = decide(situation, situation.make(BruteForce), Answers())
        assert made == [Park(situation.world.robots[0], 1)]

    def test_bundles_only_when_there_are_no_picks_then_as_long_as_there_are_some(
        self, situation
    ) -> None:
        """The bundle is for the pod that RPS chose (RAWSim-O would take any)."""
        controller = situation.make(BruteForce)
        robot = situation.world.robots[0]
        situation.waiting_bundle(pod=3, station=1)
        assert controller._best(robot, Answers()).pod == 3
        situation.stock(0, s0=9)
        situation.assigned(s0=1)
        assert controller._best(robot, Answers()).pod == 3
        situation.world.start_replenish(situation.world.robots[1], 3, 1)
        assert controller._best(robot, Answers()).pod == 0
        situation.waiting_bundle(pod=2, station=1)
        assert controller._best(robot, Answers()).pod == 0

    def test_a_robot_without_work_rests_near_by_and_is_woken(self, situation) -> None:
        controller = situation.make(BruteForce)
        made = decide(situation, controller, Answers())
        assert [task.place for task in made] == [0, 1, 2, 3]
        situation.stock(3, s0=1)
        situation.assigned(s0=1)
        made = decide(situation, controller, Answers())
        # the robot beneath the pod gets the job
        assert made == [BringForPicks(situation.world.robots[3], 3, 0)]


class TestSwarm:
    def test_stimulus(self, situation) -> None:
        """Station 0 has four orders (slots), a limit of 3 and one robot matched: 2, times 1.5.
        Station 1 has one bundle and two robots matched: 0."""
        controller = situation.make(Swarm, work_limit=3)
        for _ in range(4):
            situation.assigned(s0=1)
        situation.waiting_bundle(pod=1, station=1)
        controller._matched = [0, 1, 1, -1]
        controller._multiplier[:] = [1.5, 9.0]
        assert controller._stimulus().tolist() == [3.0, 0.0]

    def test_probabilities(self) -> None:
        """Two pick stations at x = 0 and 10 with two orders each, T = 2 // 2 = 1; robot 0 (0, 2).

        4 / (4 + 1 + 8^2) = 0.058 and 4 / (4 + 1 + 18^2) = 0.0122: station 0 in 82.7 % of the draws.
        """
        situation = Situation(small_layout(pick_stations=2, replenishment_stations=1))
        controller = situation.make(Swarm, work_limit=2, growth=1.0)
        for station in (0, 1):
            for _ in range(2):
                situation.assigned(station, s0=1)
        robot = situation.world.robots[0]
        drawn = np.bincount([controller._draw_station(robot) for _ in range(2000)], minlength=2)
        assert 0.80 < drawn[0] / 2000 < 0.855
        assert len(drawn) == 2

    def test_multipliers(self) -> None:
        """Whichever of the two is drawn gets 1, the other grows; the third has no stimulus: 1."""
        situation = Situation(small_layout(pick_stations=2, replenishment_stations=1))
        controller = situation.make(Swarm, growth=2.0, growth_limit=3.0)
        for station in (0, 1):
            situation.assigned(station, s0=1)
        controller._multiplier[:] = [1.0, 1.0, 7.0]
        robot = situation.world.robots[0]
        first = controller._draw_station(robot)
        assert controller._multiplier.tolist() == (
            [1.0, 2.0, 1.0] if first == 0 else [2.0, 1.0, 1.0]
        )
        while controller._draw_station(robot) == first:
            assert controller._multiplier.max() <= 3.0

    def test_rest(self) -> None:
        """Five stations without work, threshold round(0.8 x 5) = 4: excess 1, weight 1 / 1: rest.
        With four without work the excess is 0."""
        situation = Situation(small_layout(pick_stations=4))
        controller = situation.make(Swarm)
        assert controller._rest_weight(5) == 1.0
        assert controller._rest_weight(4) == 0.0
        assert controller._draw_station(situation.world.robots[0]) == -1
        controller = situation.make(Swarm, rest_share=0.4)
        assert controller._rest_weight(4) == pytest.approx((2 / 3) ** 3)

    def test_an_empty_robot_gets_a_pod_from_pps(self, situation) -> None:
        """Only station 0 has work; one order attracts one robot, the others rest near by."""
        situation.stock(2, s0=1)
        situation.assigned(s0=1)
        made = decide(situation, situation.make(Swarm), Answers(pods={0: 2}))
        assert made[0] == BringForPicks(situation.world.robots[0], 2, 0)
        assert [task.place for task in made[1:]] == [1, 3, 0]

    def test_a_robot_with_a_pod_keeps_its_station(self, situation) -> None:
        situation.stock(1, s0=5)
        served(situation)
        controller = situation.make(Swarm)
        controller._matched[0] = 0
        situation.assigned(s0=1)
        made = decide(situation, controller, Answers(place=6))
        assert made == [BringForPicks(situation.world.robots[0], 1, 0)]

    def test_and_parks_the_pod_when_it_is_of_no_use_there(self, situation) -> None:
        served(situation)
        controller = situation.make(Swarm)
        controller._matched[0] = 0
        assert decide(situation, controller, Answers(place=6)) == [
            Park(situation.world.robots[0], 6)
        ]

    def test_or_goes_on_to_another_station_near_by(self, situation) -> None:
        """The replenishment station is 5 m away."""
        served(situation)
        situation.waiting_bundle(pod=1, station=1)
        controller = situation.make(Swarm, other_stations=True)
        controller._matched[0] = 0
        made = decide(situation, controller, Answers(place=6, next_station=1))
        assert made == [BringForBundles(situation.world.robots[0], 1, 1)]
        assert controller._matched[0] == 1

    def test_every_robot_at_rest_draws(self, situation, monkeypatch) -> None:
        """Robot 0 draws rest; the station that robot 1 draws has work."""
        situation.stock(3, s0=1)
        situation.assigned(s0=1)
        for robot in situation.world.robots:
            situation.world.start_rest(robot, robot.waypoint)
        controller = situation.make(Swarm)
        monkeypatch.setattr(controller, "_draw_station", lambda robot: 0 if robot.index else -1)
        made = decide(situation, controller, Answers(pods={0: 3}))
        assert made[0] == BringForPicks(situation.world.robots[1], 3, 0)

    def test_robots_at_work_are_matched_when_it_is_installed(self, situation) -> None:
        situation.stock(1, s0=5)
        situation.assigned(s0=1)
        situation.world.start_pick(situation.world.robots[2], 1, 0)
        assert situation.world.robots[2].task.kind == "pick"
        assert situation.make(Swarm)._matched == [-1, -1, 0, -1]


def test_linear_asks_a_nearer_robot_if_the_work_is_not_worth_it_for_one_far_away(situation) -> None:
    """The trip to station 1 is estimated at 13 + 1 = 14 s for robot 0 and at 11 s for robot 3: sums
    of -10 x 14 / 30 = -4.67 and -3.67, of which the second is above -4. Robot 2, which stands
    beneath the pod, gets the task."""
    for robot in situation.world.robots:
        situation.world.start_rest(robot, robot.waypoint)
    situation.waiting_bundle(pod=2, station=1)
    controller = situation.make(Linear, weights={"away_s": -10.0, "rest": -4.0})
    made = decide(situation, controller, Answers(pods={1: 2}))
    assert made == [BringForBundles(situation.world.robots[2], 2, 1)]
