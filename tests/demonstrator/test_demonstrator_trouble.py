"""Whole demonstrations in which something goes wrong: nobody meets, and work goes on."""

import numpy as np
import pytest
from laboratory import RADII_M, Laboratory

from rmfs.demonstrator.emulator.unkind import KIND
from rmfs.demonstrator.server.guide import Guide


class Mischief:
    """Does something once, after a time, to the first robot that is in the middle of a run."""

    def __init__(self, second, act):
        self.second, self.act = second, act
        self.victim = self.room = None
        self.later = []

    def __call__(self, room):
        self.room = room
        if self.victim is None and room.now_us >= self.second * 1e6:
            self.victim = driving(room)
            if self.victim is not None:
                self.act(self)
        for due_us, act in list(self.later):
            if room.now_us >= due_us:
                self.later.remove((due_us, act))
                act()

    def after(self, seconds, act):
        self.later.append((self.room.now_us + round(seconds * 1e6), act))


def driving(room):
    for robot in room.robots.values():
        order = robot.program.memory.order if robot.program else None
        if order and order.turned and min(robot.base._left, robot.base._right) > 0.15:
            return robot
    return None


def troubled(folder, second, act, duration_s, real=None):
    """Run with mischief; the trips that ended well after it say whether work goes on."""
    mischief = Mischief(second, act)
    lab = Laboratory(folder, KIND, mischief=mischief, real=real)
    run = lab.run(duration_s)
    assert mischief.victim is not None
    assert not mischief.later
    assert lab.room.truth.nearest_m >= RADII_M
    trips = run.traffic.trips()
    ended_late = trips["robot"][trips["t1_us"] > 1e6 * (second + 15)]
    index = lab.robots[mischief.victim.name]
    return lab, np.bincount(ended_late, minlength=4), index


def test_a_robot_whose_program_is_killed_goes_on_when_it_is_started_again(tmp_path):
    def act(mischief):
        mischief.victim.kill()
        mischief.after(5, mischief.victim.start)

    lab, trips, _ = troubled(tmp_path, 10, act, 100)
    assert (trips > 0).all()
    assert lab.counts["given_up"] == 0


@pytest.mark.parametrize("real", [None, pytest.param("0,2", marks=pytest.mark.slow)])
def test_a_robot_pushed_off_its_path_finds_a_new_one(tmp_path, real):
    """Carried to the next lane, where its next tag is one it was not sent to."""

    def act(mischief):
        base = mischief.victim.base
        sideways = np.array([-np.sin(base.heading_rad), np.cos(base.heading_rad)])
        here = np.array([base.x_m, base.y_m])
        others = [r.base for r in mischief.room.robots.values() if r.base is not base]
        for way in (0.45, -0.45):
            there = here + way * sideways
            inside = 0.4 < there[0] < 2.6 and 1.2 < there[1] < 2.6
            free = min(np.hypot(o.x_m - there[0], o.y_m - there[1]) for o in others) > 1.2
            if inside and free:
                base.x_m, base.y_m = there
                mischief.room.truth._before = []
                return
        mischief.victim = None  # not here, not now

    lab, trips, _ = troubled(tmp_path, 10, act, 120, real)
    assert lab.counts["strayed"] >= 1
    assert lab.counts["regroupings"] >= 1
    assert (trips > 0).all()


def test_an_unknown_tag_is_noted_and_work_goes_on(tmp_path):
    def act(mischief):
        mischief.victim.tags._found = "NO SUCH TAG"

    lab, trips, _ = troubled(tmp_path, 10, act, 80)
    assert lab.counts["unknown_tags"] == 1
    assert lab.counts["strayed"] == 0
    assert (trips > 0).all()


@pytest.mark.slow
@pytest.mark.parametrize("real", [None, "1,3"])
def test_a_silent_robot_is_planned_around_and_taken_back(tmp_path, real):
    """Its computer hangs for a minute: after half of it the others go around it."""

    def act(mischief):
        victim = mischief.victim
        victim.kill()
        mischief.after(60, victim.start)

    lab, trips, index = troubled(tmp_path, 10, act, 160, real)
    assert lab.counts["given_up"] == 1
    assert lab.counts["regroupings"] >= 2
    others = [robot for robot in range(4) if robot != index]
    assert (trips[others] > 2).all()
    assert trips[index] > 0


@pytest.mark.slow
def test_a_robot_with_a_dead_battery_is_planned_around(tmp_path):
    def act(mischief):
        mischief.victim.base.battery = 0.0

    lab, trips, index = troubled(tmp_path, 10, act, 160)
    assert lab.counts["given_up"] == 1
    assert trips[index] == 0
    assert (np.delete(trips, index) > 2).all()


@pytest.mark.slow
def test_a_robot_that_sees_no_line_waits_until_somebody_puts_it_on_a_tag(tmp_path):
    """Carried to where no tape is, it reports trouble; carried back to a tag, it goes on."""

    def act(mischief):
        base = mischief.victim.base
        home = mischief.victim.program.memory.order.start
        base.x_m, base.y_m = 0.0, 0.0  # the edge of the floor
        mischief.room.truth._before = []
        mischief.after(70, lambda: put_back(mischief.room, base, int(home[1:])))

    def put_back(room, base, waypoint):
        base.x_m, base.y_m = float(room._layout.x_m[waypoint]), float(room._layout.y_m[waypoint])
        base.heading_rad = round(base.heading_rad / (np.pi / 2)) * np.pi / 2
        room.truth._before = []

    lab, trips, _ = troubled(tmp_path, 10, act, 160)
    assert lab.counts["given_up"] == 1
    assert lab.counts["troubles"] == 2
    assert (trips > 0).all()


@pytest.mark.parametrize("real", [None, "0,2"])
def test_robots_under_way_keep_their_ways_when_plans_are_made_anew(tmp_path, monkeypatch, real):
    """Every waypoint that a robot may still drive over stays its own until it has passed it."""
    tick, regroup = Guide.tick, Guide._regroup
    seen = {"ticks": 0, "kept": 0}

    def ticked(guide, *given, **options):
        seen["ticks"] += 1
        guide._regroup_due = guide._regroup_due or seen["ticks"] % 30 == 0
        return tick(guide, *given, **options)

    def regrouped(guide):
        regroup(guide)
        for robot in guide.robots.values():
            if robot.is_busy and robot.pursuit.turned and not robot.given_up:
                pursuit = robot.pursuit
                ahead = pursuit.waypoints[pursuit.passed : pursuit.granted]
                assert set(ahead) <= set(guide.traffic.clearance(robot.index))
                seen["kept"] += bool(ahead)

    monkeypatch.setattr(Guide, "tick", ticked)
    monkeypatch.setattr(Guide, "_regroup", regrouped)
    lab = Laboratory(tmp_path, KIND, real=real)
    run = lab.run(60, trace=True)
    assert lab.counts["regroupings"] > 30
    assert seen["kept"] > 20
    assert lab.room.truth.nearest_m >= RADII_M
    report = run.check()
    assert report.ok, report.summary()
    assert len(run.traffic.trips()["robot"]) > 4
