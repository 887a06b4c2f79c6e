"""The interface of the planner in any order of calls: hypothesis drives, disturbs and copies it."""

from __future__ import annotations

import hypothesis.strategies as st
import pytest
from hypothesis import HealthCheck, settings
from hypothesis.stateful import RuleBasedStateMachine, precondition, rule
from random_tasks import RandomTasks

from rmfs.layout import load
from rmfs.measure.checker import check
from rmfs.traffic import Step, Traffic

SECOND = 1_000_000
LAYOUT = load("small", [(["robots"], 6)])
QUIET = [
    place
    for place in range(LAYOUT.waypoints)
    if not LAYOUT.is_storage[place] and not LAYOUT.is_queue[place]
]
ROBOTS = st.integers(0, LAYOUT.robots - 1)
PLACES = st.lists(st.sampled_from(QUIET), min_size=1, max_size=4)
NONSENSE = st.sampled_from([-1, 2**31, 10**9, LAYOUT.waypoints])


class Driven(RuleBasedStateMachine):
    """Six robots with random tasks; much goes wrong, and in the end all is open again."""

    def __init__(self) -> None:
        super().__init__()
        self.tasks = RandomTasks(LAYOUT, seed=3)
        self.closed: set[int] = set()

    @property
    def traffic(self) -> Traffic:
        return self.tasks.traffic

    @rule(seconds=st.floats(0.0, 60.0))
    def time_passes(self, seconds: float) -> None:
        self.tasks.run(self.traffic.now_us / SECOND + seconds)

    @rule(places=PLACES)
    def close(self, places: list[int]) -> None:
        """Also what others cannot do without: they wait until it is open again."""
        self.traffic.close(places)
        self.closed.update(places)

    @rule()
    @precondition(lambda self: self.closed)
    def reopen(self) -> None:
        self.traffic.reopen(sorted(self.closed))
        self.closed.clear()

    @rule(robot=ROBOTS, by_us=st.integers(0, 30 * SECOND))
    def hold(self, robot: int, by_us: int) -> None:
        until_us = self.traffic.hold(robot, by_us)
        assert until_us is None or until_us >= self.traffic.now_us

    @rule(robot=ROBOTS, by_us=st.integers(0, 30 * SECOND))
    def delay(self, robot: int, by_us: int) -> None:
        self.traffic.delay(robot, by_us)

    @rule()
    def copy(self) -> None:
        """A copy, and one through bytes, go on as the original would."""
        copies = [self.traffic.fork(), Traffic.from_bytes(LAYOUT, self.traffic.to_bytes())]
        end = self.traffic.now_us + 5 * SECOND
        told = [one.advance(end) for one in copies]
        assert told[0] == told[1]
        self.tasks.traffic = self.traffic.fork()

    @rule(robot=ROBOTS)
    def look(self, robot: int) -> None:
        moves = self.traffic.plan(robot)
        assert all(one.end_us >= one.start_us for one in moves)
        assert self.traffic.robot_waypoint(robot) < LAYOUT.waypoints
        assert self.traffic.state_report()

    @rule(what=NONSENSE)
    def nonsense(self, what: int) -> None:
        """Is refused with a reason, and changes nothing."""
        before = self.traffic.to_bytes()
        for call in (
            lambda: self.traffic.close([what]),
            lambda: self.traffic.reopen([what]),
            lambda: self.traffic.hold(what, 1),
            lambda: self.traffic.delay(what, 1),
            lambda: self.traffic.plan(what),
            lambda: self.traffic.robot_waypoint(what),
            lambda: self.traffic.command(0, [(Step.DRIVE, what)]),
            lambda: self.traffic.command(what, [(Step.DRIVE, QUIET[0])]),
            lambda: self.traffic.hold(0, -1 - abs(what)),
        ):
            with pytest.raises((ValueError, OverflowError)):
                call()
        assert self.traffic.to_bytes() == before

    def teardown(self) -> None:
        """All is open again: tasks are done, and nobody came too near to anybody."""
        if self.closed:
            self.traffic.reopen(sorted(self.closed))
        begin = self.traffic.now_us / SECOND
        done = len(self.tasks.visits)
        self.tasks.run(begin + 300.0)
        assert len(self.tasks.visits) > done
        report = check(LAYOUT, self.traffic.trace(), until_us=self.traffic.now_us)
        assert report.ok, report.summary()


TestDriven = Driven.TestCase
TestDriven.settings = settings(
    max_examples=100,
    derandomize=True,
    stateful_step_count=20,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
