"""Simulated time in whole microseconds, and periodic times.

Whole microseconds add up exactly, are the same on every processor, and survive conversion to
decimals: a stream of orders read from a file equals the one that was written to it.
"""

from __future__ import annotations

from bisect import bisect_right
from math import ceil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.scenario.parameters import DownPeriods

US_PER_S = 1_000_000
US_PER_H = 3600 * US_PER_S

NEVER_US = 1 << 62
"""A time later than any event."""


def nearest_us(time_s: float) -> int:
    """Return the microsecond nearest to a time in s."""
    return round(time_s * US_PER_S)


def first_us(time_s: float) -> int:
    """Return the first microsecond that is not before a time in s."""
    time_us = ceil(time_s * US_PER_S)
    if (time_us - 1) / US_PER_S >= time_s:
        return time_us - 1
    return time_us if time_us / US_PER_S >= time_s else time_us + 1


class Cycle:
    """A periodic cycle that may already be under way at time zero.

    Parameters
    ----------
    length_s
        Length of the cycle, in s.
    gone_s
        Time by which the cycle has advanced at time zero, in s; may exceed its length.
    """

    def __init__(self, length_s: float, gone_s: float) -> None:
        self.length_us = nearest_us(length_s)
        self._gone_us = nearest_us(gone_s) % self.length_us

    def phase_us(self, time_us: int) -> int:
        """Return the time since the start of the current cycle at a simulated time, both in us."""
        return (time_us + self._gone_us) % self.length_us

    def times_us(self, phases_us: Sequence[int]) -> Iterator[tuple[int, int]]:
        """Yield the simulated times at which given phases occur, as pairs (time, index of phase).

        The times are in us, ascending and not negative. The sequence never ends.

        Parameters
        ----------
        phases_us
            At least one phase (a time within the cycle, in us), in ascending order, each less than
            the length of the cycle.
        """
        return _Times(list(phases_us), self.length_us, -self._gone_us)


class _Times:
    """Endlessly repeated times of a cycle, as an iterator that can be copied."""

    def __init__(self, phases_us: list[int], length_us: int, start_us: int) -> None:
        self._phases_us = phases_us
        self._length_us = length_us
        self._start_us = start_us
        self._which = 0

    def __iter__(self) -> Iterator[tuple[int, int]]:
        return self

    def __next__(self) -> tuple[int, int]:
        while True:
            if self._which == len(self._phases_us):
                self._which = 0
                self._start_us += self._length_us
            which = self._which
            self._which += 1
            if self._start_us + self._phases_us[which] >= 0:
                return self._start_us + self._phases_us[which], which


class Openings:
    """Down periods of a scenario, in which no orders or bundles arrive except in batches.

    Parameters
    ----------
    config
        The down periods; None if there are none.
    gone_s
        Time by which the cycle of down periods has advanced at time zero, in s.

    Attributes
    ----------
    always
        Whether there are no down periods.
    """

    def __init__(self, config: DownPeriods | None, gone_s: float) -> None:
        self._borders: list[int] = []
        if config is not None:
            self._cycle = Cycle(config.cycle_s, gone_s)
            # begin, end, begin, end, ...: down after an odd number of boundaries
            self._borders = [nearest_us(s) for period in config.periods_s for s in period]
        self.always = not self._borders

    def is_open(self, time_us: int) -> bool:
        """Return whether a time in us is outside all down periods.

        A period includes its start but not its end.
        """
        return self.open_from_us(time_us) == time_us

    def open_from_us(self, time_us: int) -> int:
        """Return the first time from `time_us` on that is outside all down periods, in us."""
        while self._borders:
            phase_us = self._cycle.phase_us(time_us)
            passed = bisect_right(self._borders, phase_us)
            if passed % 2 == 0:
                break
            # a period that ends with the cycle may be followed by one at its start
            time_us += self._borders[passed] - phase_us
        return time_us
