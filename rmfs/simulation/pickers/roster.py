"""Shifts and breaks of pickers."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.observer import Observer
    from rmfs.scenario.parameters.pickers import Roster
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.service import Service
    from rmfs.world import World
    from rmfs.world.pickers import Picker, Staff


class RosterClock:
    """Lets pickers come and leave according to the roster; without a roster, all come at time zero.

    Parameters
    ----------
    given
        The scenario's table `pickers.roster`, or None.
    gone_s
        Time of day at time zero, in s.
    services
        Services of all stations, pick stations first; a station that gets a picker continues its
        service.
    """

    def __init__(
        self,
        given: Roster | None,
        staff: Staff,
        gone_s: float,
        services: Sequence[Service],
        *,
        agenda: Agenda,
        world: World,
        events: Observer,
    ) -> None:
        self._staff, self._services = staff, services
        self._agenda, self._world, self._events = agenda, world, events
        self._gone_us = round(gone_s * 1e6)
        self._cycle_us = 0
        self._shifts_us: list[tuple[int, int]] = []
        self._breaks_us: list[tuple[int, int]] = []
        if given is not None:
            self._cycle_us = round(given.cycle_s * 1e6)
            self._shifts_us = [_us(period) for period in given.shifts_s]
            self._breaks_us = [_us(period) for period in given.breaks_s]

    def begin(self) -> None:
        """Let the pickers on duty at time zero come, and schedule the first change."""
        self._change()

    def _change(self) -> None:
        """Let pickers come and leave according to the current shift; schedule the next change."""
        staff, now_s = self._staff, self._world.now_s
        shift = self._shift()
        for picker in staff.pickers:
            if picker.station >= 0 and picker.shift != shift:
                self._leave(picker)
        for picker in staff.pickers:
            if picker.station < 0 and picker.shift == shift:
                staff.come(picker, now_s)
                self._services[picker.home].go_on()
        staff.next_change_s = inf
        if self._cycle_us:
            wait_us = self._until_next_us()
            staff.next_change_s = (self._agenda.now_us + wait_us) / 1e6
            self._agenda.after(wait_us, self._change)

    def _leave(self, picker: Picker) -> None:
        station, since_s = picker.station, picker.since_s
        now_s = self._world.now_s
        self._staff.leave(picker, now_s)
        self._events.picker_left(picker.index, station, since_s, max(now_s, picker.busy_until_s))

    def _shift(self) -> int:
        """Return the current shift, or -1."""
        if not self._cycle_us:
            return 0
        at_us = self._in_cycle_us
        if any(begin_us <= at_us < end_us for begin_us, end_us in self._breaks_us):
            return -1
        within = (n for n, (begin, end) in enumerate(self._shifts_us) if begin <= at_us < end)
        return next(within, -1)

    @property
    def _in_cycle_us(self) -> int:
        return (self._agenda.now_us + self._gone_us) % self._cycle_us

    def _until_next_us(self) -> int:
        at_us, cycle_us = self._in_cycle_us, self._cycle_us
        borders = {us for period in (*self._shifts_us, *self._breaks_us) for us in period}
        return min((border - at_us - 1) % cycle_us + 1 for border in borders)


def _us(period: tuple[float, float]) -> tuple[int, int]:
    return round(period[0] * 1e6), round(period[1] * 1e6)
