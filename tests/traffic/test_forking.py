"""Traffic that is copied or saved in the middle of a run goes on as if nothing had happened."""

from __future__ import annotations

import copy
import hashlib
import pickle
import random

import pytest
from random_tasks import RandomTasks

from rmfs.control import registry
from rmfs.control.choices import choose
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.layout import load
from rmfs.measure.checker import check
from rmfs.traffic import PlannerSettings, Step, Traffic
from rmfs.traffic.planner import Search

SECOND = 1_000_000
PLANNERS = [
    *({"name": name} for name in registry.built_in(Problem.PP)),
    {"name": "time-windows", "swift": True},
    {"name": "time-windows", "improve_labels": 300},
]


class Shuffled:
    """A planner in Python with a memory: whoever it draws is planned first, around the others."""

    def __init__(self):
        self.random = random.Random(7)

    def plan(self, now_us, agents):
        order = list(range(len(agents)))
        self.random.shuffle(order)
        ways = [None] * len(agents)
        for index in order:
            found = [way for way in ways if way is not None]
            ways[index] = yield Search(index, found, now_us + 20 * SECOND)
        return ways


class Disturbed(RandomTasks):
    """Random tasks; now and then a robot stops or drives slower, and waypoints are closed."""

    def __post_init__(self):
        super().__post_init__()
        self.traffic = Traffic(
            self.layout, record_trace=True, planner=self.planner, slow_shares=(0.5,)
        )
        self.bound_for = [0] * len(self.layout.stations)
        self.idle_pods = list(range(self.layout.pods))
        self.draw = random.Random(self.seed)
        self.closed = []
        aisles = ~(self.layout.is_storage | self.layout.is_queue)
        self.aisles = aisles.nonzero()[0].tolist()
        for robot in range(self.layout.robots):
            self.fetch(robot)

    def run(self, until_s):
        """Go on to a whole second, and disturb once in each."""
        for second in range(self.traffic.now_us // SECOND + 1, until_s + 1):
            super().run(second)
            robot = self.draw.randrange(self.layout.robots)
            what = self.draw.random()
            if what < 0.1:
                self.traffic.hold(robot, self.draw.randrange(20 * SECOND))
            elif what < 0.2:
                self.traffic.slow_down(robot, self.draw.randrange(2))
            elif what < 0.25:
                self.traffic.reopen(self.closed)
                self.closed = self.draw.sample(self.aisles, 2)
                self.traffic.close(self.closed)
        return self


def settings(table, seed=1):
    if table["name"] == "python":
        return PlannerSettings("python", {"period_s": 1.0, "runs_granted": 4.0}, 1, Shuffled())
    return planner_settings(choose(Problem.PP, table, "test"), seed)


def named(table):
    return "-".join(str(value) for value in table.values())


def everything(tasks):
    """A digest of all that traffic says of itself and of what it has been told, but wall times."""
    traffic = tasks.traffic
    counters = {k: v for k, v in traffic.counters().items() if k != "planning_s"}
    digest = hashlib.sha256(repr((tasks.visits, sorted(counters.items()))).encode())
    for table in (traffic.trace(), traffic.motion(), traffic.heat(), traffic.trips()):
        for name in sorted(table):
            digest.update(table[name].tobytes())
    digest.update(traffic.state_report().encode())
    return digest.hexdigest()


def forked(tasks):
    return copy.deepcopy(tasks, {id(tasks.layout): tasks.layout})


def saved(tasks):
    """A copy whose traffic has gone through bytes."""
    other = forked(tasks)
    other.traffic = Traffic.from_bytes(tasks.layout, tasks.traffic.to_bytes())
    return other


@pytest.mark.parametrize("table", [*PLANNERS, {"name": "python"}], ids=named)
def test_copies_go_on_alike(table):
    """Forked and saved again and again at random moments; the copies see other robots stop."""
    layout = load("default", [(["robots"], 12)])
    original = Disturbed(layout, 3, planner=settings(table))
    draw = random.Random(table["name"])
    for _ in range(4):
        original.run(original.traffic.now_us // SECOND + draw.randrange(20, 60))
        one, other = forked(original), saved(original)
        end = original.traffic.now_us // SECOND + 60
        expected = everything(forked(original).run(end))
        assert everything(one.run(end)) == expected
        assert everything(other.run(end)) == expected
    until_us = original.traffic.now_us
    assert original.visits
    alone = Disturbed(layout, 3, planner=settings(table)).run(until_us // SECOND)
    assert everything(original) == everything(alone)


@pytest.mark.parametrize("name", ["time-windows", "whca-n", "pibt"])
def test_copies_with_elevators(name):
    layout = load("study-tiers", [(["robots"], 12)])
    original = Disturbed(layout, 1, planner=settings({"name": name})).run(150)
    one, other = forked(original), saved(original)
    expected = everything(original.run(300))
    assert everything(one.run(300)) == expected
    assert everything(other.run(300)) == expected
    assert original.traffic.motion()["riding_s"].sum() > 0


def test_the_original_does_not_see_what_a_copy_does():
    layout = load("default", [(["robots"], 8)])
    original = RandomTasks(layout, 2).run(100)
    before = everything(original)
    copied = forked(original).run(300)
    copied.traffic.close(layout.is_storage.nonzero()[0][:50].tolist())
    copied.traffic.reset_statistics()
    assert everything(original) == before
    assert everything(copied) != before
    assert check(layout, copied.traffic.trace(), until_us=copied.traffic.now_us).ok


def test_statistics_and_the_known_trace_go_on():
    """Totals begin at the last reset, and who follows the trace goes on from the copy."""
    original = RandomTasks(load("default", [(["robots"], 8)]), 4).run(150)
    original.traffic.reset_statistics()
    _, known = original.traffic.trace_after(0)
    copied = saved(original).run(250)
    original.run(250)
    rows, count = original.traffic.trace_after(known)
    others, same = copied.traffic.trace_after(known)
    assert count == same > known
    assert all((rows[name] == others[name]).all() for name in rows)
    assert everything(copied) == everything(original)


def test_a_pickle_is_a_copy():
    tasks = RandomTasks(load("default", [(["robots"], 4)]), 1).run(60)
    copied = pickle.loads(pickle.dumps(tasks))
    assert everything(copied.run(200)) == everything(tasks.run(200))


def test_bytes_that_do_not_fit():
    layout = load("default", [(["robots"], 4)])
    saved = Traffic(layout).to_bytes()
    with pytest.raises(ValueError, match="another layout"):
        Traffic.from_bytes(load("small"), saved)
    with pytest.raises(ValueError, match="other robots"):
        Traffic.from_bytes(load("default", [(["robots"], 5)]), saved)
    with pytest.raises(ValueError, match="not the bytes"):
        Traffic.from_bytes(layout, b"something else")
    with pytest.raises(ValueError, match="damaged"):
        Traffic.from_bytes(layout, saved[:-20] + b"x" + saved[-19:])
    head, _, body = saved.partition(b"\n")
    with pytest.raises(ValueError, match="version 99"):
        Traffic.from_bytes(layout, head + b"\n" + body[:12] + bytes([99]) + body[13:])


def test_a_planner_that_cannot_be_copied_says_so():
    class Stuck:
        def __deepcopy__(self, memo):
            raise RuntimeError("not this one")

        def plan(self, now_us, agents):
            return [None] * len(agents)
            yield

    planner = PlannerSettings("python", {"period_s": 1.0, "runs_granted": 1.0}, 1, Stuck())
    traffic = Traffic(load("default", [(["robots"], 1)]), planner=planner)
    traffic.command(0, [(Step.DRIVE, 0)])
    with pytest.raises(RuntimeError, match="not this one"):
        traffic.fork()
