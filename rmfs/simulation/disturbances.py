"""Disturbances of a run, such as breakdowns of robots, closed waypoints and failed chargers."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.errors import InputError
from rmfs.random import Stream, generator
from rmfs.scenario.intake.rates import exponential_us

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.layout.model import Layout
    from rmfs.scenario.parameters.disturbances import (
        Breakdowns,
        ChargerFailures,
        Closures,
        Disturbances,
        SlowRobots,
    )
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.charging.chargers import Chargers
    from rmfs.traffic import Traffic

AGAIN_US = 1_000_000
"""Delay in us after which an impossible start or end of a disturbance is tried again."""

TRIES = 20
"""Number of waypoints tried when looking for one that can be closed."""

FOR_EVER_US = 2**62

_BREAKDOWNS, _SLOW, _CLOSURES, _CHARGERS = range(4)
_LATE_MOTIONS = 4


class Disturbance(NamedTuple):
    """One disturbance, from its start to its end.

    Late motions are a further kind of disturbance, but are not recorded as `Disturbance` objects.

    Attributes
    ----------
    kind
        `breakdown`, `slow`, `closure`, `charger` or `elevator`.
    element
        Index of the robot that breaks down or is slow, of the closed waypoint, of the station that
        is the failed charger, or of the elevator.
    from_us, to_us
        Start and end in microseconds.
    """

    kind: str
    element: int
    from_us: int
    to_us: int


class DisturbanceSource:
    """Generates the disturbances that the scenario specifies, if any.

    Parameters
    ----------
    seed
        Seed of the run.

    Attributes
    ----------
    begun
        All disturbances recorded so far, in the order of recording. While the end of a disturbance
        is unknown, `to_us` is `FOR_EVER_US`. The start and end of a breakdown are recorded
        together, possibly shortly before the breakdown starts.

    Raises
    ------
    InputError
        If an elevator that is to be out of service does not exist, or if chargers are to fail but
        the layout has none.
    """

    def __init__(
        self,
        layout: Layout,
        given: Disturbances,
        seed: int,
        *,
        agenda: Agenda,
        fleet: Traffic,
        chargers: Chargers | None = None,
    ) -> None:
        elevators = len(layout.elevators)
        for elevator, *_ in given.elevators_out:
            if elevator >= elevators:
                raise InputError(
                    f"scenario.disturbances.elevators_out: there is no elevator {elevator} (the "
                    f"layout has {elevators}, numbered from 0)"
                )
        self._layout, self._given = layout, given
        self._agenda, self._fleet, self._chargers = agenda, fleet, chargers
        if given.chargers is not None and not (chargers and chargers.stations):
            raise InputError(
                "scenario.disturbances.chargers: the layout has no station of the kind charger"
            )
        self._draw = [generator(seed, Stream.DISTURBANCES, kind) for kind in range(5)]
        self._slow_since: dict[int, int] = {}
        self.begun: list[Disturbance] = []
        self._next: dict[int, int] = {}

    @property
    def slow(self) -> list[tuple[int, int, int, float]]:
        """Periods in which robots are slow.

        Each is a tuple of the robot, the start and end in us, and the robot's speed as a share of
        its top speed.
        """
        share = self._given.slow.speed_share if self._given.slow is not None else 1.0
        slow = (one for one in self.begun if one.kind == "slow")
        return [(one.element, one.from_us, one.to_us, share) for one in slow]

    def within(self, start_s: float, end_s: float) -> tuple[int, float]:
        """Return how many disturbances overlap a period, and their total duration within it, in s.

        The durations of simultaneous disturbances are added up.
        """
        start_us, end_us = round(start_s * 1e6), round(end_s * 1e6)
        parts = [
            min(one.to_us, end_us) - max(one.from_us, start_us)
            for one in self.begun
            if one.from_us < end_us and one.to_us > start_us
        ]
        return len(parts), sum(parts) / 1e6

    def begin(self) -> None:
        """Schedule the first disturbance of each random kind, and all outages of elevators.

        Late motions are not scheduled here: from now on, traffic draws them at random.
        """
        for kind, given in enumerate(self._given_by_kind()):
            if given is not None:
                self._repeat(kind)
        late = self._given.late_motions
        if late is not None:
            least_us, most_us = round(late.least_s * 1e6), round(late.most_s * 1e6)
            self._fleet.set_lateness(
                late.probability, least_us, most_us, repair=late.repair, seed=self._lateness_seed()
            )
        for elevator, begin_s, end_s in self._given.elevators_out:
            lasting_us = round(end_s * 1e6) - round(begin_s * 1e6)
            stop = partial(self._elevator_out, elevator, lasting_us)
            self._agenda.after(round(begin_s * 1e6), stop)

    def redraw(self) -> None:
        """Redraw the next disturbance of each random kind, and all future late motions.

        Disturbances in progress continue, and outages of elevators keep their times.
        """
        for kind, serial in list(self._next.items()):
            self._agenda.cancel(serial)
            self._repeat(kind)
        if self._given.late_motions is not None:
            self._fleet.reseed_lateness(self._lateness_seed())

    def _lateness_seed(self) -> int:
        return int(self._draw[_LATE_MOTIONS].integers(2**63))

    def _given_by_kind(
        self,
    ) -> tuple[Breakdowns | SlowRobots | Closures | ChargerFailures | None, ...]:
        """Return the parameters of each kind, in the order of their numbers."""
        given = self._given
        return given.breakdowns, given.slow, given.closures, given.chargers

    def _repeat(self, kind: int) -> None:
        """Schedule the next disturbance of a kind, at a random time."""
        given = self._given_by_kind()[kind]
        assert given is not None
        gap_us = exponential_us(self._draw[kind].random(), 3600.0 / given.every_s)
        self._next[kind] = self._agenda.after(gap_us, partial(self._come, kind))

    def _come(self, kind: int) -> None:
        """Start a disturbance of a kind, and schedule the next."""
        given = self._given_by_kind()[kind]
        assert given is not None
        lasting_us = round(given.lasting_s * 1e6 * (0.5 + self._draw[kind].random()))
        if kind == _BREAKDOWNS:
            self._hold(self._robot(_BREAKDOWNS), lasting_us)
        elif kind == _SLOW:
            self._slow_down(lasting_us)
        elif kind == _CHARGERS:
            self._fail(lasting_us)
        else:
            self._close_somewhere(lasting_us)
        self._repeat(kind)

    def _note(self, kind: str, element: int, to_us: int = FOR_EVER_US) -> int:
        """Record the start of a disturbance; return its number."""
        self.begun.append(Disturbance(kind, element, self._agenda.now_us, to_us))
        return len(self.begun) - 1

    def _end(self, number: int) -> None:
        self.begun[number] = self.begun[number]._replace(to_us=self._agenda.now_us)

    def _robot(self, kind: int) -> int:
        return int(self._draw[kind].integers(self._layout.robots))

    def _hold(self, robot: int, lasting_us: int) -> None:
        until_us = self._fleet.hold(robot, lasting_us)
        if until_us is None:
            self._agenda.after(AGAIN_US, partial(self._hold, robot, lasting_us))
            return
        self.begun.append(Disturbance("breakdown", robot, until_us - lasting_us, until_us))

    def _slow_down(self, lasting_us: int) -> None:
        robot = self._robot(_SLOW)
        if robot in self._slow_since:
            return
        self._slow_since[robot] = -1
        self._begin_slow(robot, lasting_us)

    def _begin_slow(self, robot: int, lasting_us: int) -> None:
        if not self._fleet.slow_down(robot, 1):
            self._agenda.after(AGAIN_US, partial(self._begin_slow, robot, lasting_us))
            return
        self._slow_since[robot] = self._note("slow", robot)
        self._agenda.after(lasting_us, partial(self._end_slow, robot))

    def _end_slow(self, robot: int) -> None:
        if not self._fleet.slow_down(robot, 0):
            self._agenda.after(AGAIN_US, partial(self._end_slow, robot))
            return
        self._end(self._slow_since.pop(robot))

    def _close_somewhere(self, lasting_us: int) -> None:
        """Close a waypoint without which everything can still be served, if there is one."""
        traffic, layout = self._fleet, self._layout
        shafts = [place for elevator in layout.elevators for place in elevator.waypoints]
        may_close = ~layout.is_storage & ~layout.is_queue
        may_close[shafts] = False
        may_close[[one.element for one in self._now("closure")]] = False
        places = np.flatnonzero(may_close)
        already = traffic.cut_off()
        for _ in range(TRIES):
            waypoint = int(places[self._draw[_CLOSURES].integers(len(places))])
            traffic.close([waypoint])
            if traffic.cut_off() == already:
                self._closed(waypoint, lasting_us)
                return
            traffic.reopen([waypoint])

    def _fail(self, lasting_us: int) -> None:
        """Let a working charger fail."""
        assert self._chargers is not None
        failed = {one.element for one in self._now("charger")}
        working = [number for number in self._chargers.stations if number not in failed]
        if working:
            station = working[int(self._draw[_CHARGERS].integers(len(working)))]
            self._chargers.set_working(station, False)
            number = self._note("charger", station)
            self._agenda.after(lasting_us, partial(self._repair, station, number))

    def _repair(self, station: int, number: int) -> None:
        assert self._chargers is not None
        self._chargers.set_working(station, True)
        self._end(number)

    def _closed(self, waypoint: int, lasting_us: int) -> None:
        number = self._note("closure", waypoint)
        self._agenda.after(lasting_us, partial(self._reopen, [waypoint], number))

    def _now(self, kind: str) -> list[Disturbance]:
        return [one for one in self.begun if one.kind == kind and one.to_us == FOR_EVER_US]

    def _reopen(self, waypoints: Sequence[int], number: int) -> None:
        self._fleet.reopen(waypoints)
        self._end(number)

    def _elevator_out(self, elevator: int, lasting_us: int) -> None:
        waypoints = self._layout.elevators[elevator].waypoints
        self._fleet.close(waypoints)
        number = self._note("elevator", elevator)
        self._agenda.after(lasting_us, partial(self._elevator_back, elevator, number))

    def _elevator_back(self, elevator: int, number: int) -> None:
        """End an outage of an elevator, which stays closed if another outage is in progress."""
        self._end(number)
        if all(one.element != elevator for one in self._now("elevator")):
            self._fleet.reopen(self._layout.elevators[elevator].waypoints)
