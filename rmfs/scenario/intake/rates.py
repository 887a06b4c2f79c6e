"""Arrival rates that change over time."""

from __future__ import annotations

import math
from bisect import bisect_right
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

from rmfs.errors import InputError
from rmfs.random import Stream
from rmfs.scenario.clock import US_PER_H, Cycle, nearest_us
from rmfs.scenario.parameters.rates import HighLowRate, Steps
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from rmfs.scenario.parameters.rates import AnyRate


MOST_PER_H = 1e8
"""Maximum rate, at which arrivals are 36 microseconds apart on average."""


class Rate(Protocol):
    """An arrival rate, in arrivals per h, that may change over time.

    Attributes
    ----------
    peak_per_h
        Maximum rate.
    """

    peak_per_h: float

    def per_h(self, time_us: int) -> float:
        """Return the rate at the time `time_us`."""

    def redraw(self, now_us: int) -> None:
        """Redraw the random changes of the rate that occur after `now_us`."""


def rate_of(config: AnyRate, per_h: float, scale: float, gone_s: float, seed: int) -> Rate:
    """Return the rate specified in a scenario.

    Parameters
    ----------
    config
        The table `profile` of a scenario's demand or replenishment.
    per_h
        Mean rate, in arrivals per h; with a high-low profile, the rate in low periods.
    scale
        Factor on all rates: the number of stations if rates are per station, else 1.
    gone_s
        Time by which all cycles have advanced at time zero, in s.
    seed
        The run's seed.

    Raises
    ------
    InputError
        If the maximum rate exceeds `MOST_PER_H`.
    """
    rate: Rate
    if isinstance(config, HighLowRate):
        rate = _HighLow(config, per_h * scale, config.high_per_h * scale, seed)
    elif isinstance(config, Steps):
        rate = _InSteps(config, per_h * scale, gone_s)
    else:
        rate = _Constant(per_h * scale)
    if rate.peak_per_h > MOST_PER_H:
        raise InputError(
            f"a rate of {rate.peak_per_h:g} per h is too high (maximum: {MOST_PER_H:g})"
        )
    return rate


class _Fixed:
    """A rate without random elements."""

    def redraw(self, now_us: int) -> None:
        """Do nothing, as the rate has no random changes."""


class _Constant(_Fixed):
    def __init__(self, per_h: float) -> None:
        self.peak_per_h = per_h

    def per_h(self, time_us: int) -> float:
        return self.peak_per_h


class _InSteps(_Fixed):
    """A step function with a given mean over a cycle.

    The mean is weighted by the lengths of the steps.
    """

    def __init__(self, config: Steps, mean_per_h: float, gone_s: float) -> None:
        self._cycle = Cycle(config.cycle_s, gone_s)
        count = len(config.weights)
        starts_s = config.starts_s or [config.cycle_s * step / count for step in range(count)]
        ends_s = [*starts_s, config.cycle_s]
        # fsum is correctly rounded, so that the rates are the same on every processor
        total = math.fsum(
            weight * (end - start)
            for weight, (start, end) in zip(config.weights, pairwise(ends_s), strict=True)
        )
        self._starts_us = [nearest_us(start_s) for start_s in starts_s]
        self._per_h = [mean_per_h * weight * config.cycle_s / total for weight in config.weights]
        self.peak_per_h = max(self._per_h)

    def per_h(self, time_us: int) -> float:
        return self._per_h[bisect_right(self._starts_us, self._cycle.phase_us(time_us)) - 1]


class _HighLow:
    """Low and high periods of exponential length, shared by orders and bundles of a run."""

    def __init__(self, config: HighLowRate, low_per_h: float, high_per_h: float, seed: int) -> None:
        self._rates = low_per_h, high_per_h
        self.peak_per_h = max(self._rates)
        self._switches_per_h = config.low_to_high_per_h, config.high_to_low_per_h
        self._substreams = Substreams(seed, Stream.ORDER_ARRIVALS, (1,))
        self._switches_us: list[int] = []

    def per_h(self, time_us: int) -> float:
        switches = self._switches_us
        while not switches or switches[-1] <= time_us:
            switches.append((switches[-1] if switches else 0) + self._length_us(len(switches)))
        return self._rates[bisect_right(switches, time_us) % 2]

    def redraw(self, now_us: int) -> None:
        """Redraw the rest of the current period, whose length is memoryless."""
        switches = self._switches_us
        del switches[bisect_right(switches, now_us) :]
        switches.append(now_us + self._length_us(len(switches)))

    def _length_us(self, period: int) -> int:
        """Return the length of a period; even-numbered periods are low."""
        uniform = self._substreams.at(period)()
        return exponential_us(uniform, self._switches_per_h[period % 2])


def exponential_us(uniform: float, per_h: float) -> int:
    """Convert a number in [0, 1) to the time in us until the next event of a Poisson process.

    Processors may differ in the last bits of the logarithm; rounding to whole microseconds removes
    these bits.

    Parameters
    ----------
    per_h
        Rate of the process, in events per h.
    """
    return round(-math.log1p(-uniform) / per_h * US_PER_H)
