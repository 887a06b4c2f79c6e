"""Drives a stream of trips and measures the results."""

from __future__ import annotations

import heapq
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.checker import check
from rmfs.traffic import COST_TABLE_BYTES, TIME_WINDOWS, PlannerSettings, Traffic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.measure.checker import CheckReport
    from rmfs.trips.streams import Command, TripStream

STALL_S = 1800.0
"""Driving stops early if no event occurs for this time, in s, while robots wait for a path."""


@dataclass(frozen=True)
class TripRun:
    """The result of driving a stream of trips.

    Attributes
    ----------
    warmup_s, duration_s
        Simulated time of the warm-up, and measured time after it, in s.
    end_s
        Simulated time at which driving ended, in s: the end of the measured time or, if no robot
        could move any more, an earlier time, perhaps in the warm-up. Even then, rates refer to the
        whole of `duration_s`, as nothing more would have happened.
    wall_s
        Wall time after the warm-up, in s.
    stalled
        Positions of all robots if none could move any more; otherwise empty.
    report
        Result of the trace checker, if it was requested.
    """

    layout: Layout
    planner: PlannerSettings
    traffic: Traffic
    warmup_s: float
    duration_s: float
    end_s: float
    wall_s: float
    stalled: str
    report: CheckReport | None

    @property
    def trips_per_h(self) -> float:
        """Number of trips finished after the warm-up, to goals of any kind, per simulated hour."""
        return len(self.delays_s) / self.duration_s * 3600.0

    @property
    def delays_s(self) -> NDArray[np.float64]:
        """Delay of each trip in s: its duration minus its unhindered duration."""
        trips = self.traffic.trips()
        taken: NDArray[np.float64] = (trips["t1_us"] - trips["t0_us"]) / 1e6
        unhindered: NDArray[np.float64] = trips["unhindered_s"]
        return taken - unhindered

    @property
    def idle_robots(self) -> int:
        """Number of robots that finished no trip after the warm-up."""
        return self.layout.robots - len(np.unique(self.traffic.trips()["robot"]))

    @property
    def distance_m(self) -> float:
        """Distance driven by all robots after the warm-up, in m."""
        return float(self.traffic.motion()["distance_m"].sum())


def drive(
    layout: Layout,
    stream: TripStream,
    planner: PlannerSettings = TIME_WINDOWS,
    *,
    duration_s: float,
    warmup_s: float = 0.0,
    proven: bool = False,
    stall_s: float = STALL_S,
    cost_table_bytes: int = COST_TABLE_BYTES,
    each: Callable[[Traffic], None] | None = None,
) -> TripRun:
    """Drive a stream of trips.

    Parameters
    ----------
    duration_s, warmup_s
        Measured simulated time, and simulated time of the warm-up before it, in s.
    proven
        Whether the independent checker should prove the motion safe. If so, the trace is recorded.
    stall_s
        Driving stops early if no event occurs for this time, in s, while robots wait for a path.
    cost_table_bytes
        Memory, in bytes, for tables of unhindered travel times.
    each
        Function that is called with the `Traffic` object after each advance of simulated time. An
        advance ends at the next event at the latest.
    """
    traffic = Traffic(
        layout, record_trace=proven, planner=planner, cost_table_bytes=cost_table_bytes
    )
    loop = _Loop(traffic, stream, stall_s, each)
    loop.until(warmup_s)
    traffic.reset_statistics()
    begun = time.perf_counter()
    loop.until(warmup_s + duration_s)
    wall_s = time.perf_counter() - begun
    end_us = traffic.now_us
    report = check(layout, traffic.trace(), until_us=end_us) if proven else None
    times = (warmup_s, duration_s, end_us / 1e6, wall_s)
    return TripRun(layout, planner, traffic, *times, loop.stalled, report)


class _Loop:
    """Passes commands to traffic, and events to the stream."""

    def __init__(
        self,
        traffic: Traffic,
        stream: TripStream,
        stall_s: float,
        each: Callable[[Traffic], None] | None,
    ) -> None:
        self.traffic, self.stream, self.each = traffic, stream, each
        self.stalled = ""
        self._stall_us = round(stall_s * 1e6)
        self._moved_us = 0
        self._later: list[tuple[int, int, Command]] = []
        self._serial = 0
        self._take(stream.begin())
        self._give()

    def until(self, end_s: float) -> None:
        """Simulate up to a time, or until nothing can move any more."""
        traffic, stream, end_us = self.traffic, self.stream, round(end_s * 1e6)
        while not self.stalled and traffic.now_us < end_us:
            due_us = self._later[0][0] if self._later else end_us
            events = traffic.advance(min(due_us, end_us, self._moved_us + self._stall_us))
            for event in events:
                self._moved_us = event[0]
                self._take(stream.follow(*event))
            self._give()
            if self.each is not None:
                self.each(traffic)
            if traffic.now_us >= self._moved_us + self._stall_us:
                self._look()

    def _take(self, commands: Iterable[Command]) -> None:
        for command in commands:
            self._serial += 1
            heapq.heappush(self._later, (command.at_us, self._serial, command))

    def _give(self) -> None:
        """Pass on the commands that are due."""
        while self._later and self._later[0][0] <= self.traffic.now_us:
            _, _, command = heapq.heappop(self._later)
            self._moved_us = self.traffic.now_us
            self.traffic.command(command.robot, command.program)
            self._take(self.stream.given(command))

    def _look(self) -> None:
        """Stop after a long time without events if robots wait for a path and no command is due."""
        self._moved_us = self.traffic.now_us
        if self.traffic.blocked() and not self._later:
            self.stalled = self.traffic.state_report()
