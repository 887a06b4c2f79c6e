"""Pickers at the pick stations: where they are, what they have done, and how tired they are."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf
from typing import TYPE_CHECKING, NamedTuple

from rmfs.scenario.pick_times import UnitTimes, learned, least_factor

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.scenario.parameters.pickers import Pickers

HOUR_S = 3600.0
"""Seconds per hour: rates of fatigue are per hour."""


def after_work(fatigue: float, rate_per_h: float, work_s: float) -> float:
    """Return the fatigue after a period of work: F + (1 - F) (1 - exp(-rate x time)).

    F is the fatigue before this period. Source: Jaber, Givi and Neumann (2013), Applied
    Mathematical Modelling 37, 7287-7299.
    """
    return 1.0 - (1.0 - fatigue) * exp(-rate_per_h * work_s / HOUR_S)


def after_rest(fatigue: float, rate_per_h: float, rest_s: float) -> float:
    """Return the fatigue after a period of rest: F exp(-rate x time); F as in `after_work`."""
    return fatigue * exp(-rate_per_h * rest_s / HOUR_S)


@dataclass(slots=True, eq=False)
class Picker:
    """A picker.

    Attributes
    ----------
    index
        Number of the picker; pickers of the first shift come first.
    shift
        Number of the picker's shift.
    home
        Pick station at which the picker works during the shift.
    speed
        Relative speed; at 2, a unit takes half as long as at 1.
    station
        Current station, or -1 while away.
    since_s
        Start of the present or last period at a station, in s. After a break that was shorter than
        the rest of a unit, this is the end of the unit, up to which the previous period lasts.
    units
        Units picked since time zero.
    fatigue
        Fatigue at `told_s`, 0 to 1; `Staff.fatigue` returns the current value.
    told_s
        Time to which `fatigue` refers, in s.
    busy_until_s
        Time at which the most recently started unit is finished, in s.
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
    """Record of how a unit was picked.

    Attributes
    ----------
    picker
        Index of the picker.
    seconds
        Time for which the unit occupied picker and station, in s, rework included.
    robot_s
        Time for which the unit occupied the robot, in s.
    layer
        Layer in which the unit lay, counted from 0 at the bottom; -1 if pods have no layers.
    fatigue
        Fatigue of the picker when the pick began, 0 to 1.
    error, noticed
        Whether the unit was picked wrongly, and whether this was noticed and corrected at once.
    face
        Face on which the unit lay; -1 if pods have no faces.
    turned
        Whether the pod had to be turned; `seconds` and `robot_s` include the time for turning.
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
        The scenario's parameters of pickers.
    pickers
        The pickers.
    unit_s
        Time per unit at each pick station according to the layout, in s.

    Attributes
    ----------
    pickers
        The pickers, by index.
    at_station
        The picker at each pick station, or None.
    next_change_s
        Time at which pickers come or leave next, in s; infinite if never.
    unit_times
        Distribution of the time per unit, without the effects of picker and pod.

    Raises
    ------
    InputError
        If the scenario names a file of measured times per unit that is invalid.
    """

    def __init__(self, given: Pickers, pickers: Sequence[Picker], unit_s: Sequence[float]) -> None:
        self.given = given
        self.pickers = list(pickers)
        self.at_station: list[Picker | None] = [None] * len(unit_s)
        self.next_change_s = inf
        self.unit_times = UnitTimes(given.unit_time)
        self._unit_s = list(unit_s)

    def come(self, picker: Picker, now_s: float) -> None:
        """Record that a picker has come to the station `picker.home`."""
        self.bring(picker, now_s)
        picker.station, picker.since_s = picker.home, max(now_s, picker.busy_until_s)
        self.at_station[picker.home] = picker

    def leave(self, picker: Picker, now_s: float) -> None:
        """Record that a picker has left; the rest of a unit already started counts as work."""
        self.bring(picker, now_s)
        self.at_station[picker.station] = None
        picker.station = -1

    def begin_unit(self, picker: Picker, now_s: float, seconds: float) -> None:
        """Record that a picker starts a unit, which takes `seconds`."""
        self.bring(picker, now_s)
        picker.units += 1
        picker.busy_until_s = now_s + seconds

    def bring(self, picker: Picker, now_s: float) -> None:
        """Set the stored fatigue of a picker to its current value."""
        picker.fatigue, picker.told_s = self.fatigue(picker, now_s), now_s

    def fatigue(self, picker: Picker, now_s: float) -> float:
        """Return the current fatigue of a picker, 0 to 1."""
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
        """Return the factor by which learning, speed and fatigue scale the next unit's time."""
        made = learned(self.given.learning, picker.units) / picker.speed
        if self.given.fatigue is not None:
            made *= 1.0 + self.given.fatigue.slowdown * self.fatigue(picker, now_s)
        return made

    def unit_s(self, station: int, now_s: float) -> float:
        """Return the current mean time of a unit at a station, in s; inf if no picker is there.

        The effects of layers, faces and errors are left out.
        """
        picker = self.at_station[station]
        if picker is None:
            return inf
        return self.unit_times.mean_s(self._unit_s[station]) * self.factor(picker, now_s)

    def least_s(self, station_s: float) -> float:
        """Return a lower bound on the time of a unit, in s; 0 if there is no positive bound.

        Parameters
        ----------
        station_s
            Time of a unit according to the layout, in s.
        """
        return self.unit_times.least_s(station_s) * least_factor(self.given)

    def verify(self) -> None:
        """Check that `at_station` agrees with the stations stored for the pickers.

        Raises
        ------
        AssertionError
            If they differ.
        """
        told = {(one.index, one.station) for one in self.pickers if one.station >= 0}
        there = {(one.index, n) for n, one in enumerate(self.at_station) if one is not None}
        if told != there:
            raise AssertionError("inconsistent world: pickers at stations")
