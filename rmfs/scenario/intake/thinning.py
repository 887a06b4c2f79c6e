"""Poisson processes whose rate changes, by thinning.

Candidates come with the greatest rate there ever is, and each is accepted with probability
(present rate) / (greatest rate): the result is a Poisson process with the changing rate, exact at
the borders of its steps (Lewis and Shedler 1979, "Simulation of nonhomogeneous Poisson processes by
thinning"). What a candidate is, depends on the seed and its ordinal only.
"""

from __future__ import annotations

from itertools import count
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
        By which its contents are drawn.
    time_us
        When it comes.
    needed_share
        It comes if a greater share of the stations is active, where rates are tied to them; below
        1, so that it always comes if all are.
    """

    ordinal: int
    time_us: int
    needed_share: float = 0.0


def poisson(
    rate: Rate, substreams: Substreams, openings: Openings, until_us: int
) -> Iterator[Candidate]:
    """Yield the arrivals of a Poisson process with a changing rate.

    The ordinal is that of the candidate, so that two runs in which different candidates are
    accepted still agree in the contents of those that both accept.

    Parameters
    ----------
    substreams
        Candidate k takes its gap and its acceptance from substream k.
    openings
        While generation is down the rate is zero.
    until_us
        The last time of interest.
    """
    if rate.peak_per_h == 0:
        return
    time_us = 0
    for ordinal in count():
        uniform = substreams.at(ordinal)
        time_us += exponential_us(uniform(), rate.peak_per_h)
        if time_us > until_us:
            return
        level = uniform() * rate.peak_per_h
        present = rate.per_h(time_us)
        if level < present and openings.is_open(time_us):
            yield Candidate(ordinal, time_us, level / present)
