"""SA staffed: pick stations take new work while a picker is present and not too tired."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import SwitchStation
from rmfs.control.sa import StationActivation

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.world.pickers import Staff

Share = Annotated[float, pydantic.Field(ge=0, le=1)]


class StaffedParameters(Parameters):
    """Parameters of SA staffed."""

    tired: Share = 1.0
    """Fatigue (0 to 1) at or above which a picker gets no new work. With 1, fatigue has no
    effect."""
    rested: Share = 0.5
    """Fatigue at or below which a tired picker gets work again; must be less than `tired`."""
    look_every_s: Annotated[float, pydantic.Field(ge=1, le=86400)] = 60.0
    """Time between checks of fatigue, in seconds, from 1 to 86,400."""

    @pydantic.model_validator(mode="after")
    def _in_order(self) -> StaffedParameters:
        if self.rested >= self.tired:
            raise ValueError(f"rested must be below tired = {self.tired:g}")
        return self


class Staffed(StationActivation[StaffedParameters]):
    """Switches pick stations on and off by the roster of the scenario and the pickers' fatigue.

    A pick station is switched off when its picker leaves or when the picker's fatigue reaches
    `tired`; a tired picker still finishes open orders. The station is switched on when it has a
    picker and the picker's fatigue is at most `rested`. If `tired` is 1, fatigue has no effect.
    Replenishment stations are always on. If the scenario has no pickers, all stations are always
    on.
    """

    parameters_model = StaffedParameters

    def decide(self) -> Iterator[SwitchStation]:
        """Yield, for each station that is not in the desired state, a decision to switch it."""
        staff = self.view.staff
        for station in self.view.stations:
            on = staff is None or station.index >= len(staff.at_station)
            if staff is not None and not on:
                on = self._works(staff, station.index, active=station.active)
            if station.active != on:
                yield SwitchStation(station.index, active=on)

    def next_event_s(self) -> float:
        """Return the simulated time, in s, at which this rule must decide again; inf if never.

        This is the time of the next change of shift or of the next check of fatigue, whichever is
        earlier.
        """
        staff = self.view.staff
        if staff is None:
            return inf
        if staff.given.fatigue is None or self.parameters.tired >= 1.0:
            return staff.next_change_s
        return min(staff.next_change_s, self.view.now_s + self.parameters.look_every_s)

    def _works(self, staff: Staff, station: int, *, active: bool) -> bool:
        picker = staff.at_station[station]
        if picker is None:
            return False
        fatigue = staff.fatigue(picker, self.view.now_s)
        if active:
            return fatigue < self.parameters.tired or self.parameters.tired >= 1.0
        return self.parameters.tired >= 1.0 or fatigue <= self.parameters.rested
