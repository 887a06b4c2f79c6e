"""The robot's program on the emulated floor, without a server."""

import math
from itertools import pairwise

import numpy as np
import pytest

from rmfs import layout as layouts
from rmfs.demonstrator.emulator.base import EmulatedBase
from rmfs.demonstrator.emulator.floor import Floor
from rmfs.demonstrator.emulator.sensors import FloorCamera, FloorTags
from rmfs.demonstrator.emulator.truth import Truth
from rmfs.demonstrator.emulator.unkind import KIND, Unkindness
from rmfs.demonstrator.robot.create2 import Create2
from rmfs.demonstrator.robot.lines import CameraLine
from rmfs.demonstrator.robot.pid import Pid
from rmfs.demonstrator.robot.program import Program

TICK_US = 50_000
GLARING = Unkindness(0.05, 0.02, 0.0, 0.0, 0, glare=0.3, noise=15.0, gap_m=0.06)


class Told:
    """A link: what the server says is put in, what the robot says can be read."""

    def __init__(self):
        self.inbox, self.said = [], []

    def poll(self, now_us):
        inbox, self.inbox = self.inbox, []
        return inbox

    def send(self, message):
        self.said.append(message)
        return True

    def flush(self, now_us):
        pass


class Robot:
    """A robot at waypoint 0 of a lane, with its program."""

    def __init__(self, at, heading_rad=0.0, unkindness=KIND, seed=3, memory=None):
        self.plan = layouts.load("demonstrator")
        self.rng = np.random.default_rng(seed)
        self.base = EmulatedBase(
            float(self.plan.x_m[at]),
            float(self.plan.y_m[at]),
            heading_rad,
            1.0 + unkindness.speed_error,
            unkindness.slip,
            self.rng,
        )
        self.reader = FloorTags(
            [f"W{w}" for w in range(36)],
            self.plan.x_m,
            self.plan.y_m,
            self.base,
            unkindness.missed_tags,
            self.rng,
        )
        floor = Floor(self.plan, unkindness, self.rng)
        self.line = CameraLine(FloorCamera(floor, self.base, self.rng))
        self.memory = memory
        self.truth = Truth.of(self.plan)
        self.now_us = 0
        self.start()

    def start(self):
        self.link = Told()
        self.program = Program(
            Create2(self.base), self.line, self.reader, self.link, memory=self.memory
        )

    def go(self, number, way, turn=(), granted=None):
        tags = [f"W{w}" for w in way[1:]]
        steps = pairwise(way)
        x, y = self.plan.x_m, self.plan.y_m
        self.link.inbox.append(
            {
                "type": "go",
                "id": number,
                "actions": [*turn, *["straight"] * len(tags)],
                "start": f"W{way[0]}",
                "tags": tags,
                "metres": [float(math.hypot(x[b] - x[a], y[b] - y[a])) for a, b in steps],
                "granted": len(tags) if granted is None else granted,
                "turned": not turn,
                "passed": 0,
            }
        )

    def roll(self, seconds, each=None):
        """Let time pass; return how far the robot was beside the lane, tick by tick."""
        beside = []
        for _ in range(round(seconds * 1e6 / TICK_US)):
            if each is not None:
                each()
            self.program.step(self.now_us)
            for _ in range(2):
                self.base.roll(TICK_US / 2e6)
                self.reader.look()
                self.truth.look([self.base], TICK_US / 2e6)
            self.now_us += TICK_US
            beside.append(self.base.y_m - 1.275)
        return np.array(beside)

    def said(self, kind):
        return [message for message in self.link.said if message["type"] == kind]

    def stands_at(self, waypoint, within=0.02):
        x, y = self.plan.x_m[waypoint], self.plan.y_m[waypoint]
        return math.hypot(self.base.x_m - x, self.base.y_m - y) < within and not self.base._left


LANE = [12, 13, 14, 15, 16, 17]


@pytest.mark.parametrize("unkindness", [KIND, Unkindness(), GLARING], ids=["kind", "usual", "bad"])
@pytest.mark.parametrize("seed", [1, 2])
def test_line_following_stays_within_a_centimetre(unkindness, seed):
    """2.25 m at 0.21 m/s, with crossings; noise, glare and gaps in the tape."""
    robot = Robot(12, unkindness=unkindness, seed=seed)
    robot.go(1, LANE)
    beside = robot.roll(20)
    assert [message["tag"] for message in robot.said("tag")][-1] == "W17"
    assert len(robot.said("done")) == 1
    assert robot.stands_at(17)
    assert np.abs(beside).mean() < 0.01
    assert robot.truth.lateral_mean_m < 0.01


@pytest.mark.parametrize("kick", [0.05, -0.05])
@pytest.mark.parametrize("unkindness", [KIND, GLARING], ids=["kind", "bad"])
def test_a_kick_of_five_centimetres_is_made_good(kick, unkindness):
    robot = Robot(12, unkindness=unkindness)
    robot.go(1, LANE)
    robot.roll(4.0)
    robot.base.y_m += kick
    beside = robot.roll(16)
    assert abs(beside[0]) > 0.04
    assert np.abs(beside[100:]).max() < 0.015  # five seconds, one metre later
    assert robot.stands_at(17)
    assert len(robot.said("done")) == 1


def test_a_kick_with_a_twist():
    robot = Robot(12)
    robot.go(1, LANE)
    robot.roll(4.0)
    robot.base.y_m += 0.05
    robot.base.heading_rad += math.radians(10)
    beside = robot.roll(16)
    assert np.abs(beside[120:]).max() < 0.015
    assert robot.stands_at(17)


@pytest.mark.parametrize(("turn", "degrees"), [("left", 90), ("right", -90), ("around", 180)])
def test_turning_on_the_spot(turn, degrees):
    robot = Robot(14)
    here = (robot.base.x_m, robot.base.y_m)
    robot.go(1, [14], [turn])
    robot.roll(5)
    assert math.degrees(robot.base.heading_rad) == pytest.approx(degrees, abs=3)
    assert math.hypot(robot.base.x_m - here[0], robot.base.y_m - here[1]) < 0.005
    assert [m["type"] for m in robot.link.said if m["type"] != "seen"] == ["turned", "done"]


def test_a_full_turn_takes_as_long_as_the_layout_says():
    """The plan gives half of 5.5 s for turning around; the robot may need a little more."""
    robot = Robot(14)
    robot.go(1, [14], ["around"])
    while not robot.said("turned"):
        robot.roll(0.05)
        assert robot.now_us < 5e6
    assert 2.5e6 < robot.now_us < 3.6e6


def test_it_waits_where_its_grant_ends():
    robot = Robot(12)
    robot.go(1, LANE, granted=2)
    robot.roll(10)
    assert robot.stands_at(14)
    assert robot.said("done") == []
    robot.link.inbox.append({"type": "grant", "id": 1, "granted": 5})
    robot.roll(15)
    assert robot.stands_at(17)


def test_an_order_is_cut_short():
    robot = Robot(12)
    robot.go(1, LANE, granted=2)
    robot.roll(1)
    robot.link.inbox.append({"type": "cut", "id": 1, "upto": 2})
    robot.roll(9)
    assert robot.stands_at(14)
    assert len(robot.said("done")) == 1


@pytest.mark.parametrize("seed", range(3))
def test_missed_tags_on_the_way_and_at_the_end(seed):
    """The reader misses every second tag: passed over on the way, looked for at the end."""
    unkindness = Unkindness(0.03, 0.01, 0.5, 0.0, 0, 0.0, 0.0, 0.0)
    robot = Robot(12, unkindness=unkindness, seed=seed)
    robot.go(1, LANE)
    robot.roll(60)
    assert len(robot.said("done")) == 1
    assert robot.stands_at(17, within=0.05)


def test_a_tag_that_is_not_ahead_stops_the_robot():
    robot = Robot(12)
    robot.go(1, LANE)
    robot.roll(1)
    robot.base.y_m += 0.45  # the next lane: its next tag is W19
    robot.roll(5)
    (astray,) = robot.said("astray")
    assert astray == {"type": "astray", "id": 1, "tag": "W19"}
    assert robot.base._left == 0.0


def test_without_a_line_it_stops_soon():
    robot = Robot(12)
    robot.go(1, LANE)
    robot.roll(1)
    robot.base.y_m = 3.05  # beside the floor's tape
    before = robot.base.x_m
    robot.roll(10)
    (trouble,) = robot.said("trouble")
    assert (trouble["id"], trouble["reason"]) == (1, "no line")
    assert robot.base.x_m - before < 0.4
    assert robot.base._left == 0.0


def test_killed_and_started_again_it_goes_on(tmp_path):
    robot = Robot(12, memory=tmp_path / "robot.json")
    robot.go(1, LANE)
    robot.roll(6)
    robot.base.stop()  # the guard
    robot.start()
    robot.link.inbox.append({"type": "connected"})
    robot.roll(15)
    assert robot.said("state")[0]["id"] == 1
    assert robot.stands_at(17)
    assert len(robot.said("done")) == 1


def test_the_same_order_again_is_not_done_twice(tmp_path):
    robot = Robot(12)
    robot.go(1, [12, 13])
    robot.roll(6)
    robot.go(1, [12, 13])
    robot.roll(3)
    assert robot.stands_at(13)
    assert len(robot.said("done")) == 1
    assert robot.said("state")[-1]["last_done"] == 1


@pytest.mark.parametrize(
    "message",
    [
        {"type": "go"},
        {"type": "go", "id": "x", "actions": [], "start": "W1"},
        {"type": "go", "id": 3, "actions": ["fly"], "start": "W1", "tags": ["W2"], "metres": [1]},
        {"type": "grant", "id": 1, "granted": "many"},
    ],
)
def test_orders_that_make_no_sense_are_reported_and_not_obeyed(message):
    robot = Robot(12)
    robot.go(1, LANE, granted=1)
    robot.roll(5)
    robot.link.inbox.append(message)
    robot.roll(1)
    assert len(robot.said("trouble")) == 1
    assert robot.stands_at(13)


def test_pid_by_hand():
    """Error 0.1 twice, a second apart: 2 * 0.1 + 0.5 * (0.1 + 0.1) + 0 = 0.3."""
    pid = Pid(2.0, 0.5, 1.0, limit=1.0)
    assert pid.output(0.1, 1.0) == pytest.approx(0.2 + 0.05)
    assert pid.output(0.1, 1.0) == pytest.approx(0.2 + 0.1)
    assert pid.output(0.2, 1.0) == pytest.approx(0.4 + 0.2 + 0.1)
    assert pid.output(9.0, 1.0) == 1.0
    assert pid.output(-9.0, 1.0) == -1.0
    pid.reset()
    assert pid.output(0.1, 1.0) == pytest.approx(0.25)
