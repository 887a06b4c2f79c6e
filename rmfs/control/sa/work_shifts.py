"""SA work-shifts: switches all stations on and off by the clock."""

from __future__ import annotations

from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import SwitchStation
from rmfs.control.sa import StationActivation

if TYPE_CHECKING:
    from collections.abc import Iterator


class Shift(Parameters):
    """A period in which all stations are on, or all are off.

    It lasts from `at_s` to the next shift. The sequence of shifts repeats in a loop, by default
    every day (`WorkShiftsParameters.loop_s`).
    """

    at_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]
    """Seconds since the start of the loop."""
    on: bool
    """Whether stations are on from that time."""


class WorkShiftsParameters(Parameters):
    """Parameters of SA work-shifts."""

    shifts: Annotated[tuple[Shift, ...], pydantic.Field(min_length=1)] = (
        Shift(at_s=0.0, on=False),
        Shift(at_s=21600.0, on=True),
        Shift(at_s=79200.0, on=False),
    )
    """The shifts in order of time. Each has `at_s` (its start, in seconds since the start of the
    loop) and `on` (whether stations are on during the shift). The first shift must start at 0."""
    loop_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 86400.0
    """Length of the loop in seconds, after which the shifts repeat."""

    @pydantic.model_validator(mode="after")
    def _in_order(self) -> WorkShiftsParameters:
        times = [shift.at_s for shift in self.shifts]
        if times[0] != 0:
            raise ValueError(f"shifts must begin with one at_s = 0 (given: {times[0]:g})")
        if any(a >= b for a, b in pairwise([*times, self.loop_s])):
            raise ValueError("shifts must ascend in at_s and end before loop_s")
        return self


class WorkShifts(StationActivation[WorkShiftsParameters]):
    """Switches all stations on or off together, at the same times of every day.

    Shifts can also repeat in a loop that is longer or shorter than a day (`loop_s`). The first loop
    begins at time of day 0 (midnight). The run begins at the time of day given by the scenario
    (`time_of_day_s`).
    """

    parameters_model = WorkShiftsParameters

    def decide(self) -> Iterator[SwitchStation]:
        """Yield, for each station whose state is not that of the shift, a decision to switch it."""
        on = self._present()[0]
        for station in self.view.stations:
            if station.active != on:
                yield SwitchStation(station.index, active=on)

    def next_event_s(self) -> float:
        """Return the simulated time, in s, at which stations are switched next; inf if never."""
        return self._present()[1]

    def _present(self) -> tuple[bool, float]:
        """Return whether stations are on now, and the simulated time, in s, of the next change."""
        given, gone_s = self.parameters, self.view.time_of_day_s
        now_s = self.view.now_s + gone_s
        states = {shift.on for shift in given.shifts}
        begin_s = now_s // given.loop_s * given.loop_s
        starts = [
            (begin_s + loop * given.loop_s + shift.at_s, shift.on)
            for loop in range(2)
            for shift in given.shifts
        ]
        on = [state for at_s, state in starts if at_s <= now_s][-1]
        if len(states) == 1:
            return on, inf
        return on, next(at_s for at_s, state in starts if at_s > now_s and state != on) - gone_s
