"""Every rule of the checker: a trace that keeps it, and one that breaks just this one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scripted_trace import HOLD, RUN, TURN, RobotScript, Script, grid

from rmfs.errors import InputError
from rmfs.layout.model import RobotKind
from rmfs.measure.checker import FindingKind, check


def kinds(report):
    return {finding.kind for finding in report.findings}


def drive(layout, *programs):
    script = Script(layout)
    for robot, program in enumerate(programs):
        program(script.robot(robot))
    return script.columns()


def round_trip():
    """One robot fetches a pod, carries it around the corner and stores it elsewhere."""
    layout = grid(6, 4, [6], pods=(9,), storage=(20,))

    def program(robot: RobotScript) -> None:
        robot.hold(3.0).run(9).lift(0).run(8).run(20).set_down().run(22).hold(5.0)

    return layout, drive(layout, program)


def test_a_lawful_trace_is_accepted():
    layout, trace = round_trip()
    report = check(layout, trace)
    assert report.ok, report.summary()
    assert report.collisions == 0
    assert report.pieces == len(trace["robot"])
    assert "safe" in report.summary()


def test_rows_may_come_in_any_order_and_as_a_frame():
    pandas = pytest.importorskip("pandas")
    layout, trace = round_trip()
    assert check(layout, pandas.DataFrame(trace).sample(frac=1, random_state=1)).ok


@pytest.mark.parametrize(
    ("column", "row", "change", "expected"),
    [
        ("t1_us", 0, 1_000_000, FindingKind.GAP),
        ("t1_us", 0, -1_000_000, FindingKind.GAP),
        ("from_wp", 1, -1, FindingKind.JUMP),
        ("to_wp", 0, 1, FindingKind.JUMP),
        ("heading0_rad", 1, 0.1, FindingKind.HEADING),
        ("heading1_rad", 0, 0.1, FindingKind.HEADING),
    ],
)
def test_a_changed_value_is_noticed(column, row, change, expected):
    layout, trace = round_trip()
    trace[column][row] += change
    report = check(layout, trace)
    assert expected in kinds(report)
    assert report.findings[0].robots == (0,)


def test_the_first_row_begins_where_the_layout_puts_the_robot():
    layout, trace = round_trip()
    layout.robot_waypoint[0] = 7
    report = check(layout, trace)
    assert kinds(report) == {FindingKind.JUMP}
    assert report.findings[0].amount == pytest.approx(1.0)


def test_a_robot_without_trace_is_noticed():
    layout = grid(6, 2, [0, 11])
    report = check(layout, drive(layout, lambda robot: robot.hold(5)), until_us=5_000_000)
    (finding,) = report.findings
    assert (finding.kind, finding.robots, finding.amount) == (FindingKind.GAP, (1,), 5.0)


def test_a_trace_that_ends_early_is_noticed():
    layout, trace = round_trip()
    end = int(trace["t1_us"].max())
    assert kinds(check(layout, trace, until_us=end + 1)) == {FindingKind.GAP}


@pytest.mark.parametrize("kind", [RUN, TURN])
@pytest.mark.parametrize("off_us", [-200_000, -3, 3, 200_000])
def test_motion_faster_or_slower_than_the_robot_is_noticed(kind, off_us):
    layout, trace = round_trip()
    row = int(np.argmax(trace["kind"] == kind))
    trace["t1_us"][row] += off_us
    trace["t0_us"][row + 1 :] += off_us
    trace["t1_us"][row + 1 :] += off_us
    report = check(layout, trace)
    assert kinds(report) == {FindingKind.DURATION}
    assert report.findings[0].amount == pytest.approx(off_us * 1e-6, abs=2e-6)


def test_limits_are_those_of_the_robots_own_kind():
    slow = RobotKind(0.35, 0.25, 0.4, 1.0, 5.0, 3.0)
    fast = RobotKind(0.35, 0.5, 0.5, 1.5, 2.5, 2.2)
    layout = grid(9, 3, [0, 18], kinds=(slow, fast), robot_kind=[1, 0])
    trace = drive(layout, lambda r: r.run(8).run(17), lambda r: r.run(26))
    assert check(layout, trace).ok
    layout.robot_kind[:] = 0
    assert kinds(check(layout, trace)) == {FindingKind.DURATION}


def test_the_last_motion_may_be_cut_short():
    layout, trace = round_trip()
    cut = int(trace["t0_us"][4]) + 500_000
    keep = trace["t0_us"] < cut
    trace = {name: column[keep] for name, column in trace.items()}
    trace["t1_us"][-1] = cut
    assert check(layout, trace).ok


def test_a_run_needs_edges_in_its_direction():
    layout = grid(6, 1, [0])
    trace = drive(layout, lambda robot: robot.run(5))
    assert check(layout, trace).ok
    start = layout.edge_start
    forward = start[2] + np.flatnonzero(layout.edge_target[start[2] : start[3]] == 3)
    layout.edge_target[forward] = 1  # the edge from 2 to 3 is gone
    report = check(layout, trace)
    assert kinds(report) == {FindingKind.EDGE}
    assert report.findings[0].amount == pytest.approx(5.0)


def test_a_run_across_the_hall_needs_diagonal_edges():
    layout = grid(3, 3, [0])
    assert kinds(check(layout, drive(layout, lambda robot: robot.run(4)))) == {FindingKind.EDGE}


def test_robots_that_meet_head_on_collide():
    layout = grid(9, 1, [0, 8])
    trace = drive(layout, lambda r: r.run(8), lambda r: r.run(0))
    report = check(layout, trace)
    (finding,) = report.of(FindingKind.ROBOTS_OVERLAP)
    assert finding.robots == (0, 1)
    assert report.collisions == 1
    assert finding.amount == pytest.approx(0.7)  # their centres meet
    # they meet after 1.25 s, in which robot 1 turns, at equal distance from both ends
    assert 3 < finding.time_s < 6


def test_a_near_miss_is_told_from_a_touch():
    """A robot passes another at exactly the sum of their radii, and a micrometre closer."""
    for shift, safe in [(0.0, True), (-5e-6, False)]:
        layout = grid(9, 2, [0, 13])
        layout.y_m[9:] = 0.7 + shift
        report = check(layout, drive(layout, lambda r: r.run(8), lambda r: r.hold(1)))
        assert (FindingKind.ROBOTS_OVERLAP not in kinds(report)) == safe


def test_a_carried_pod_makes_the_robot_wider():
    """Empty robots pass each other at 0.75 m; with pods of radius 0.4 m both ways they do not."""
    for loaded in (False, True):
        layout = grid(9, 2, [0, 9], pods=(0, 9))
        layout.y_m[9:] = 0.75

        def program(robot, end, loaded=loaded):
            if loaded:
                robot.lift(robot.number)
            robot.run(end)

        layout.pod_waypoint[:] = [0, 9] if loaded else [8, 17]
        layout.is_storage[:] = True
        report = check(layout, drive(layout, lambda r: program(r, 8), lambda r: program(r, 17)))
        assert (FindingKind.ROBOTS_OVERLAP in kinds(report)) == loaded


def test_two_overlaps_of_one_pair_are_two_collisions():
    layout = grid(9, 3, [0, 4])
    trace = drive(
        layout,
        lambda r: r.hold(1).run(2).run(3).run(0).hold(1).run(4).run(0),
        lambda r: r.hold(60),
    )
    report = check(layout, trace)
    assert len(report.of(FindingKind.ROBOTS_OVERLAP)) == 1  # stopping at 3 is 1 m away: lawful
    trace = drive(layout, lambda r: r.run(4).run(0).hold(1).run(4).run(0), lambda r: r.hold(60))
    report = check(layout, trace)
    assert report.collisions == 2


def test_robots_on_different_tiers_do_not_meet():
    layout = grid(5, 1, [0, 9], tiers=2)
    assert check(layout, drive(layout, lambda r: r.run(4), lambda r: r.run(5))).ok


def test_a_guided_robot_may_be_anywhere_on_its_way():
    """The other one crosses behind it or before it: either way they could meet."""
    layout = grid(5, 3, [5, 2])
    for wait_s, safe in ((0.0, False), (30.0, False), (61.0, True)):
        trace = drive(
            layout,
            lambda r: r.guided(6, 1).guided(8, 60).guided(9, 1),
            lambda r, wait_s=wait_s: r.hold(wait_s + 2).run(12),
        )
        assert check(layout, trace).ok is safe, wait_s


def test_two_guided_robots_keep_ways_apart():
    layout = grid(5, 3, [5, 2])
    apart = drive(layout, lambda r: r.guided(6, 9), lambda r: r.guided(12, 9))
    assert check(layout, apart).ok
    cross = drive(layout, lambda r: r.guided(8, 9), lambda r: r.guided(12, 9))
    assert kinds(check(layout, cross)) == {FindingKind.ROBOTS_OVERLAP}


def test_a_guided_pod_keeps_off_stored_ones():
    layout = grid(9, 2, [0], pods=(0, 4))
    report = check(layout, drive(layout, lambda r: r.lift(0).guided(8, 99)))
    assert kinds(report) == {FindingKind.POD_CROSSED}
    assert check(layout, drive(layout, lambda r: r.lift(0).guided(3, 99))).ok


def test_a_guided_robot_stays_on_edges():
    layout = grid(3, 3, [0])
    assert check(layout, drive(layout, lambda r: r.guided(2, 5).guided(8, 5))).ok
    assert FindingKind.EDGE in kinds(check(layout, drive(layout, lambda r: r.guided(4, 5))))


def test_a_ride_takes_the_elevators_time_and_leaves_the_tier():
    layout = grid(5, 1, [0, 2], tiers=2, elevator=2)
    trace = drive(
        layout,
        lambda r: r.hold(4).run(2).hold(1).run(4),
        lambda r: r.hold(1).ride(7).run(9),
    )
    report = check(layout, trace)
    # robot 0 stands at the elevator's door below while it is away: the elevator has one cabin
    assert kinds(report) == {FindingKind.ELEVATOR_SHARED}
    trace = drive(layout, lambda r: r.hold(10).run(2).ride(7), lambda r: r.hold(1).ride(7).run(9))
    assert check(layout, trace).ok


def test_a_ride_of_the_wrong_length_or_between_strange_places_is_noticed():
    layout = grid(5, 1, [2], tiers=2, elevator=2)
    assert kinds(check(layout, drive(layout, lambda r: r.ride(7, 9.0).hold(1)))) == {
        FindingKind.DURATION
    }
    assert kinds(check(layout, drive(layout, lambda r: r.ride(8)))) == {FindingKind.ELEVATOR_PAIR}


def test_two_robots_do_not_ride_together():
    layout = grid(5, 1, [2, 7], tiers=2, elevator=2)
    report = check(layout, drive(layout, lambda r: r.ride(7), lambda r: r.hold(5).ride(2)))
    assert FindingKind.ELEVATOR_SHARED in kinds(report)
    finding = report.of(FindingKind.ELEVATOR_SHARED)[0]
    assert (finding.robots, finding.amount) == ((0, 1), 5.0)


def test_a_row_that_takes_no_time_hides_no_shared_elevator():
    layout = grid(5, 1, [2, 5, 7], tiers=2, elevator=2)
    programs = (
        lambda r: r.hold(30),
        lambda r: r.hold(5).run(7).hold(10),
        lambda r: r.hold(0).run(9).hold(20),
    )
    (finding,) = check(layout, drive(layout, *programs)).of(FindingKind.ELEVATOR_SHARED)
    assert (finding.robots, finding.time_s) == ((0, 1), 9.0)


def test_a_queue_place_holds_one_robot():
    layout = grid(5, 1, [0, 1], queue=(1,))
    report = check(layout, drive(layout, lambda r: r.run(1), lambda r: r.hold(9)))
    assert {FindingKind.QUEUE_PLACE_SHARED, FindingKind.ROBOTS_OVERLAP} == kinds(report)
    finding = report.of(FindingKind.QUEUE_PLACE_SHARED)[0]
    assert (finding.place, finding.robots) == (1, (0, 1))


def test_an_empty_robot_may_pass_and_rest_beneath_a_pod():
    layout = grid(9, 1, [0], pods=(4,))
    assert check(layout, drive(layout, lambda r: r.run(4).hold(5).run(8))).ok


def test_a_loaded_robot_may_not_cross_a_stored_pod():
    layout = grid(9, 1, [0], pods=(0, 4))
    report = check(layout, drive(layout, lambda r: r.lift(0).run(8)))
    (finding,) = report.findings
    assert finding.kind == FindingKind.POD_CROSSED
    assert (finding.robots, finding.place) == ((0,), 4)
    assert finding.amount == pytest.approx(0.8)
    assert report.collisions == 1


def test_a_loaded_robot_may_pass_beside_stored_pods():
    layout = grid(9, 2, [0], pods=(0, 10, 12, 14))
    assert check(layout, drive(layout, lambda r: r.lift(0).run(8))).ok


def test_a_loaded_robot_may_not_drive_where_a_pod_was_put_meanwhile():
    """The place is free when the first run passes and taken when the second does."""
    layout = grid(9, 2, [0, 9], pods=(0, 9), storage=(4,))

    def second(robot):
        robot.lift(1).hold(12).run(13).run(4).set_down().run(13)

    fine = drive(layout, lambda r: r.lift(0).run(8).hold(1), second)
    assert check(layout, fine).ok
    bad = drive(layout, lambda r: r.lift(0).run(8).hold(30).run(0), second)
    report = check(layout, bad)
    assert kinds(report) == {FindingKind.POD_CROSSED}
    assert report.findings[0].place == 4


def test_a_pod_is_lifted_where_it_stands():
    layout = grid(9, 1, [0], pods=(4,))
    report = check(layout, drive(layout, lambda r: r.lift(0)))
    assert kinds(report) == {FindingKind.POD_HANDLING}


def test_a_pod_is_not_lifted_by_two_robots():
    layout = grid(9, 2, [0, 9], pods=(0,))
    trace = drive(layout, lambda r: r.lift(0).run(8), lambda r: r.hold(20).run(0).lift(0))
    assert kinds(check(layout, trace)) == {FindingKind.POD_HANDLING}


def test_a_carried_pod_does_not_vanish():
    layout, trace = round_trip()
    row = int(np.flatnonzero(trace["pod"] >= 0)[2])
    trace["pod"][row] = -1
    assert FindingKind.POD_HANDLING in kinds(check(layout, trace))


def test_pods_are_stored_one_to_a_place():
    layout = grid(9, 1, [0], pods=(0, 4))
    report = check(layout, drive(layout, lambda r: r.lift(0).run(4).set_down()))
    assert {FindingKind.POD_PLACE, FindingKind.POD_CROSSED} == kinds(report)


def test_pods_are_stored_at_storage_places_only():
    layout = grid(9, 1, [0], pods=(0,))
    report = check(layout, drive(layout, lambda r: r.lift(0).run(4).set_down()))
    assert kinds(report) == {FindingKind.POD_PLACE}


@pytest.mark.parametrize(
    ("column", "value", "text"),
    [
        ("robot", 1, "robot 1"),
        ("from_wp", 24, "from_wp 24"),
        ("pod", -2, "pod -2"),
        ("kind", 7, "kind 7"),
    ],
)
def test_rows_that_mean_nothing_are_refused(column, value, text):
    layout, trace = round_trip()
    trace[column][2] = value
    with pytest.raises(InputError, match=text):
        check(layout, trace)


def test_missing_columns_are_named():
    layout, trace = round_trip()
    del trace["pod"]
    with pytest.raises(InputError, match="column pod missing"):
        check(layout, trace)


def test_findings_read_well():
    layout = grid(9, 1, [0, 8])
    trace = drive(layout, lambda r: r.run(8), lambda r: r.hold(20))
    report = check(layout, trace)
    line = str(report.findings[0])
    assert "robot 0 and robot 1" in line and "at waypoint 8" in line and "overlap by 0.7 m" in line
    assert "robots overlap: 1" in report.summary()


def test_an_endless_hold_is_one_row():
    """Rows that span many slabs of time are compared once with each other."""
    layout = grid(3, 1, [0, 2])
    trace = drive(layout, lambda r: r.hold(3600), lambda r: r.hold(3600))
    assert trace["kind"].tolist() == [HOLD, HOLD]
    assert check(layout, trace).ok
    assert math.isclose(trace["t1_us"][0], 3.6e9)


def test_a_trace_without_rows_misses_every_robot():
    layout = grid(3, 1, [0, 2])
    report = check(layout, Script(layout).columns(0.0), until_us=7_000_000)
    assert [finding.robots for finding in report.findings] == [(0,), (1,)]
    assert kinds(report) == {FindingKind.GAP}


def test_the_hall_may_lie_anywhere():
    """Negative coordinates and a late begin change nothing."""
    for shift, late in [(0.0, 0), (-1000.0, 86_400_000_000)]:
        layout = grid(9, 1, [0, 8])
        layout.x_m[:] += shift
        trace = drive(layout, lambda r: r.run(8), lambda r: r.run(0))
        trace["t0_us"] += late
        trace["t1_us"] += late
        (finding,) = check(layout, trace).of(FindingKind.ROBOTS_OVERLAP)
        assert finding.amount == pytest.approx(0.7, abs=1e-6)
