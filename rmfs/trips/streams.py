"""Streams of trips: sequences of commands for robots.

The commands of a robot depend on the seed and on the number of trips that the robot has finished,
but not on the durations of these trips. Different planners therefore drive the same trips. Goals
that all robots share are an exception: each goes to the first robot that needs a goal.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from rmfs.errors import InputError
from rmfs.random import Stream, generator
from rmfs.traffic import EventKind, Step

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rmfs.layout.model import Layout

SERVICE_S = 5.0
"""Mean service time of a pod in s; short, so that differences between planners show."""


class Command(NamedTuple):
    """A command to a robot.

    Attributes
    ----------
    at_us
        Time, in microseconds, at which the command is to be given.
    program
        Steps that the robot is to carry out, in the form that `Traffic.command` expects.
    """

    at_us: int
    robot: int
    program: list[tuple[int, int]]


class TripStream(Protocol):
    """A source of commands for robots."""

    def begin(self) -> Iterable[Command]:
        """Return the commands at time zero."""

    def follow(self, time_us: int, kind: int, robot: int, value: int) -> Iterable[Command]:
        """Return the commands that follow an event of traffic."""

    def given(self, command: Command) -> Iterable[Command]:
        """Return commands that can be given to other robots once `command` has been given."""


class PodTrips:
    """Robots fetch pods, bring them to stations and store them again.

    Pods and free storage locations are divided among the robots, so that robots do not affect each
    other's choices. If the queue of a station has n places, including the station itself, at most
    max(1, n - 1) robots are assigned to the station at a time, although condition W3 of
    `docs/safety.md` allows n. Further robots wait beneath their pods.

    Parameters
    ----------
    seed
        Seed, 0 or greater, with which pods, stations, storage locations and service times are
        drawn.
    service_s
        Mean service time of a pod in s. Service times are uniform from 0.5 to 1.5 times this mean.

    Raises
    ------
    InputError
        If there are fewer pods than robots, or no stations.
    """

    def __init__(self, layout: Layout, seed: int, *, service_s: float = SERVICE_S) -> None:
        if not layout.stations or layout.pods < layout.robots:
            raise InputError(
                f"layout {layout.name}: trips of pods need stations and a pod per robot (it has "
                f"{len(layout.stations)} stations, {layout.pods} pods, {layout.robots} robots)"
            )
        self._service_us = service_s * 1e6
        self._random = [generator(seed, Stream.TRIPS, robot) for robot in range(layout.robots)]
        shuffled = generator(seed, Stream.TRIPS).permutation
        taken = set(layout.pod_waypoint.tolist())
        free = [int(v) for v in np.flatnonzero(layout.is_storage) if int(v) not in taken]
        self._pods = _dealt(shuffled(layout.pods).tolist(), layout.robots)
        self._places = _dealt([free[k] for k in shuffled(len(free))], layout.robots)
        self._place_of = layout.pod_waypoint.tolist()
        self._carried = [-1] * layout.robots
        self._station = [-1] * layout.robots
        self._room = [max(1, len(station.queue) - 1) for station in layout.stations]
        self._waiting: list[deque[int]] = [deque() for _ in layout.stations]

    def begin(self) -> Iterator[Command]:
        """Send every robot to its first pod."""
        for robot in range(len(self._pods)):
            yield from self._next(0, robot)

    def follow(self, time_us: int, kind: int, robot: int, _value: int) -> Iterator[Command]:
        """Return the next command of a robot that has reached a station or done all its steps."""
        if kind == EventKind.AT_HEAD:
            yield self._store(time_us, robot)
        elif kind == EventKind.IDLE and robot not in self._waiting[self._station[robot]]:
            self._pods[robot].append(self._carried[robot])
            yield from self._next(time_us, robot)

    def given(self, command: Command) -> Iterator[Command]:
        """When a robot leaves a station, send the next waiting robot to that station."""
        station = self._station[command.robot]
        if command.program[-1][0] != Step.SET_DOWN:
            return
        self._room[station] += 1
        if self._waiting[station]:
            yield self._fetch(command.at_us, self._waiting[station].popleft())

    def _next(self, time_us: int, robot: int) -> Iterator[Command]:
        """Choose the next pod and station; if there is no room, wait beneath the pod."""
        draw = self._random[robot]
        pods = self._pods[robot]
        pod = self._carried[robot] = pods.pop(int(draw.integers(len(pods))))
        station = self._station[robot] = int(draw.integers(len(self._room)))
        if self._room[station]:
            yield self._fetch(time_us, robot)
        else:
            self._waiting[station].append(robot)
            yield Command(time_us, robot, [(int(Step.DRIVE), self._place_of[pod])])

    def _fetch(self, time_us: int, robot: int) -> Command:
        pod, station = self._carried[robot], self._station[robot]
        self._room[station] -= 1
        place = self._place_of[pod]
        program = [(Step.DRIVE, place), (Step.LIFT, pod), (Step.STATION, station)]
        return Command(time_us, robot, [(int(step), value) for step, value in program])

    def _store(self, time_us: int, robot: int) -> Command:
        """Store the pod after its service, at its old place or a free one."""
        draw = self._random[robot]
        served_us = time_us + round(self._service_us * (0.5 + draw.random()))
        pod, places = self._carried[robot], self._places[robot]
        places.append(self._place_of[pod])
        place = self._place_of[pod] = places.pop(int(draw.integers(len(places))))
        return Command(served_us, robot, [(int(Step.DRIVE), place), (int(Step.SET_DOWN), pod)])


class PointTrips:
    """Robots drive from point to point, without pods.

    Parameters
    ----------
    goals
        For each robot, the waypoints to which it drives, in order.
    shared
        Further goals, given in this order to robots that have reached all their own goals.
    """

    def __init__(self, goals: Sequence[Iterable[int]], shared: Iterable[int] = ()) -> None:
        self._goals = [iter(own) for own in goals]
        self._shared = iter(shared)

    def begin(self) -> Iterator[Command]:
        """Send every robot to its first goal."""
        for robot in range(len(self._goals)):
            yield from self._next(0, robot)

    def follow(self, time_us: int, kind: int, robot: int, _value: int) -> Iterator[Command]:
        """Send a robot to its next goal after its arrival."""
        if kind == EventKind.IDLE:
            yield from self._next(time_us, robot)

    def given(self, _command: Command) -> Iterator[Command]:
        """Return no commands, since no robot waits for another robot's command."""
        return iter(())

    def _next(self, time_us: int, robot: int) -> Iterator[Command]:
        goal = next(self._goals[robot], None)
        if goal is None:
            goal = next(self._shared, None)
        if goal is not None:
            yield Command(time_us, robot, [(int(Step.DRIVE), goal)])


def random_goals(goals: Sequence[int], seed: int, robot: int) -> Iterator[int]:
    """Draw an endless sequence from two or more goals, never the same goal twice in a row."""
    draw = generator(seed, Stream.TRIPS, robot)
    last = -1
    while True:
        goal = int(goals[int(draw.integers(len(goals)))])
        if goal != last:
            last = goal
            yield goal


def random_trips(layout: Layout, seed: int, *, service_s: float = SERVICE_S) -> TripStream:
    """Return trips suitable for a layout.

    If the layout has stations and pods, the result is `PodTrips`. Otherwise robots drive between
    storage locations or, if there are fewer than two of them, between any waypoints.

    Raises
    ------
    InputError
        If a layout with stations and pods has fewer pods than robots, or any other layout has
        fewer than two waypoints.
    """
    if layout.stations and layout.pods:
        return PodTrips(layout, seed, service_s=service_s)
    goals = np.flatnonzero(layout.is_storage)
    if len(goals) < 2:
        goals = np.arange(layout.waypoints)
    if len(goals) < 2:
        raise InputError(f"layout {layout.name}: trips need two waypoints")
    named = goals.tolist()
    return PointTrips([random_goals(named, seed, robot) for robot in range(layout.robots)])


def _dealt(things: Sequence[int], hands: int) -> list[list[int]]:
    """Divide things among `hands` lists, in turn."""
    return [list(things[hand::hands]) for hand in range(hands)]
