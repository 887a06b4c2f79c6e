"""Poisson processes whose rate changes, by thinning.

Candidates arrive with the maximum rate, and each is accepted with probability (current rate) /
(maximum rate). The result is a Poisson process with the changing rate, exact at the boundaries of
steps (Lewis and Shedler 1979, "Simulation of nonhomogeneous Poisson processes by thinning"). The
content of a candidate depends only on the seed and its ordinal.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.scenario.intake.rates import exponential_us

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.scenario.clock import Openings
    from rmfs.scenario.intake.rates import Rate
    from rmfs.scenario.substreams import Substreams


class Candidate(NamedTuple):
    """A possible arrival.

    Attributes
    ----------
    ordinal
        Number of the candidate, which determines its contents.
    time_us
        Arrival time.
    needed_share
        If rates are tied to stations, the candidate is accepted if more than this share of them is
        active. It is below 1, so a candidate is always accepted if all stations are active.
    """

    ordinal: int
    time_us: int
    needed_share: float = 0.0


class Poisson:
    """The arrivals of a Poisson process with a changing rate, as an iterator that can be copied.

    Ordinals count all candidates, also those not accepted, so that two runs that accept different
    candidates agree in the contents of those that both accept.

    Parameters
    ----------
    substreams
        Substream k determines the time between candidates k - 1 and k, and whether k is accepted.
    openings
        Tells whether a time is outside the down periods, in which the rate is zero.
    until_us
        Time after which no arrival is generated.
    """

    def __init__(
        self, rate: Rate, substreams: Substreams, openings: Openings, until_us: int
    ) -> None:
        self._rate = rate
        self._substreams = substreams
        self._openings = openings
        self._until_us = until_us
        self._time_us = 0 if rate.peak_per_h else until_us + 1
        self._ordinal = 0

    def redraw(self, now_us: int) -> None:
        """Redraw all arrivals after a time; this is valid because the process is memoryless."""
        self._rate.redraw(now_us)
        if self._rate.peak_per_h:
            self._time_us = now_us

    def __iter__(self) -> Iterator[Candidate]:
        return self

    def __next__(self) -> Candidate:
        rate = self._rate
        while self._time_us <= self._until_us:
            ordinal = self._ordinal
            uniform = self._substreams.at(ordinal)
            self._ordinal += 1
            self._time_us = time_us = self._time_us + exponential_us(uniform(), rate.peak_per_h)
            if time_us > self._until_us:
                break
            level = uniform() * rate.peak_per_h
            present = rate.per_h(time_us)
            if level < present and self._openings.is_open(time_us):
                return Candidate(ordinal, time_us, level / present)
        raise StopIteration
