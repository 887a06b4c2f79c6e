"""Departures of trucks: the due time of an order is postponed to the next departure."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

from rmfs.scenario.clock import Cycle, nearest_us

if TYPE_CHECKING:
    from rmfs.scenario.due import DepartureDue


class Departures:
    """Postpones due times to the next departure.

    Parameters
    ----------
    given
        The table `orders.due` of a scenario.
    gone_s
        Time by which the cycle of departures has advanced at time zero, in s.
    """

    def __init__(self, given: DepartureDue, gone_s: float) -> None:
        self._cycle = Cycle(given.cycle_s, gone_s)
        self._phases_us = [nearest_us(time_s) for time_s in given.times_s]

    def next_us(self, time_us: int) -> int:
        """Return the first departure at or after a time, both in us."""
        phase_us = self._cycle.phase_us(time_us)
        which = bisect_left(self._phases_us, phase_us)
        if which == len(self._phases_us):
            return time_us - phase_us + self._cycle.length_us + self._phases_us[0]
        return time_us - phase_us + self._phases_us[which]
