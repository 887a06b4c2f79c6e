"""People at the pick stations: who is where, what they have done, and how tired they are."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf
from typing import TYPE_CHECKING, NamedTuple

from rmfs.scenario.pick_times import UnitTimes, learned, least_factor

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.scenario.parameters.pickers import Pickers

HOUR_S = 3600.0
"""Seconds of an hour: rates of fatigue are per hour."""


def after_work(fatigue: float, rate_per_h: float, work_s: float) -> float:
    """Return the fatigue after some work: F + (1 - F) (1 - exp(-rate x time)).

    Source: Jaber, Givi and Neumann (2013), Applied Mathematical Modelling 37, 7287-7299.
    """
    return 1.0 - (1.0 - fatigue) * exp(-rate_per_h * work_s / HOUR_S)


def after_rest(fatigue: float, rate_per_h: float, rest_s: float) -> float:
    """Return the fatigue that is left after a rest: F exp(-rate x time); source as above."""
    return fatigue * exp(-rate_per_h * rest_s / HOUR_S)


@dataclass(slots=True, eq=False)
class Picker:
    """A person.

    Attributes
    ----------
    index
        Number; those of the first shift come first.
    shift
        Number of the shift.
    home
        Pick station of that shift.
    speed
        1 is that of the station's times; who has 2 takes half of them.
    station
        Where the picker is, -1 while away.
    since_s
        Since when.
    units
        Units picked since time zero.
    fatigue
        At `told_s`; 0 to 1. What it is now says `Staff.fatigue`.
    told_s
        When that was.
    busy_until_s
        When the last unit begun is done.
    """

    index: int
    shift: int
    home: int
    speed: float
    station: int = -1
    since_s: float = 0.0
    units: int = 0
    fatigue: float = 0.0
    told_s: float = 0.0
    busy_until_s: float = 0.0


class Handled(NamedTuple):
    """What the pick of a unit was.

    Attributes
    ----------
    picker
        Index.
    seconds
        For which it keeps picker and station, rework included.
    robot_s
        For which it keeps the robot.
    layer
        Of the pod, from 0 at the floor; -1 where pods have none.
    fatigue
        Of the picker when it began.
    error, noticed
        Whether it was the wrong one, and whether that was put right.
    face
        Of the pod; -1 where pods have none.
    turned
        Whether the pod had to be turned for it; `seconds` and `robot_s` hold the time of it.
    """

    picker: int
    seconds: float
    robot_s: float
    layer: int
    fatigue: float
    error: bool
    noticed: bool
    face: int = -1
    turned: bool = False


class Staff:
    """All pickers.

    Parameters
    ----------
    given
        What the scenario says.
    pickers
        The people.
    unit_s
        What a unit takes at each pick station as the layout says, in s.

    Attributes
    ----------
    pickers
        By index.
    at_station
        The picker at each pick station, or None.
    next_change_s
        When pickers come or leave next; infinite if they never do.
    unit_times
        How long units keep a picker who is like the station's times.

    Raises
    ------
    InputError
        If the file of measured times is broken.
    """

    def __init__(self, given: Pickers, pickers: Sequence[Picker], unit_s: Sequence[float]) -> None:
        self.given = given
        self.pickers = list(pickers)
        self.at_station: list[Picker | None] = [None] * len(unit_s)
        self.next_change_s = inf
        self.unit_times = UnitTimes(given.unit_time)
        self._unit_s = list(unit_s)

    def come(self, picker: Picker, now_s: float) -> None:
        """Let a picker take the place at the home station."""
        self.bring(picker, now_s)
        picker.station, picker.since_s = picker.home, now_s
        self.at_station[picker.home] = picker

    def leave(self, picker: Picker, now_s: float) -> None:
        """Let a picker go; a unit that has been begun is done first."""
        self.bring(picker, now_s)
        self.at_station[picker.station] = None
        picker.station = -1

    def begin_unit(self, picker: Picker, now_s: float, seconds: float) -> None:
        """Let a picker work for a unit."""
        self.bring(picker, now_s)
        picker.units += 1
        picker.busy_until_s = now_s + seconds

    def bring(self, picker: Picker, now_s: float) -> None:
        """Bring what is told of the fatigue of a picker up to now."""
        picker.fatigue, picker.told_s = self.fatigue(picker, now_s), now_s

    def fatigue(self, picker: Picker, now_s: float) -> float:
        """Return the fatigue of a picker now; 0 to 1."""
        given = self.given.fatigue
        if given is None:
            return 0.0
        fatigue, told_s = picker.fatigue, picker.told_s
        worked_s = min(picker.busy_until_s, now_s) - told_s
        if worked_s > 0.0:
            fatigue = after_work(fatigue, given.per_h, worked_s)
            told_s += worked_s
        if now_s > told_s:
            waits = picker.station >= 0
            rate_per_h = given.recovery_per_h * (given.waiting_rests if waits else 1.0)
            fatigue = after_rest(fatigue, rate_per_h, now_s - told_s)
        return fatigue

    def factor(self, picker: Picker, now_s: float) -> float:
        """Return what the time of the next unit of a picker is multiplied by, but for its layer."""
        made = learned(self.given.learning, picker.units) / picker.speed
        if self.given.fatigue is not None:
            made *= 1.0 + self.given.fatigue.slowdown * self.fatigue(picker, now_s)
        return made

    def unit_s(self, station: int, now_s: float) -> float:
        """Return how long a unit takes the picker of a station in the mean now; else infinite."""
        picker = self.at_station[station]
        if picker is None:
            return inf
        return self.unit_times.mean_s(self._unit_s[station]) * self.factor(picker, now_s)

    def least_s(self, station_s: float) -> float:
        """Return the time in s that no unit is picked in less, where the layout says `station_s`.

        It is 0 if there is no such time.
        """
        return self.unit_times.least_s(station_s) * least_factor(self.given)

    def verify(self) -> None:
        """Check by recounting that everybody is where the stations say.

        Raises
        ------
        AssertionError
            If not.
        """
        told = {(one.index, one.station) for one in self.pickers if one.station >= 0}
        there = {(one.index, n) for n, one in enumerate(self.at_station) if one is not None}
        if told != there:
            raise AssertionError("inconsistent world: pickers at stations")
