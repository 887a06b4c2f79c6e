"""Base class of the classes that create the intakes of orders and of bundles."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Generic, TypeVar

from rmfs.scenario.clock import Openings, first_us
from rmfs.scenario.intake.intake import Intake, Process
from rmfs.scenario.intake.rates import rate_of
from rmfs.scenario.intake.thinning import Candidate, Poisson
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rmfs.random import Stream
    from rmfs.scenario.intake.state import Site
    from rmfs.scenario.parameters import Scenario
    from rmfs.scenario.parameters.calendar import DownPeriods
    from rmfs.scenario.parameters.rates import AnyRate
    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import BundleStream, OrderStream

T = TypeVar("T")


class Assembly(ABC, Generic[T]):
    """Creates an intake of batches and of regular arrivals (all arrivals that are not in a batch).

    Parameters
    ----------
    scenario, skus, site, seed
        As for `order_intake`.
    down
        Down periods of the orders or bundles; None if there are none.
    """

    def __init__(
        self, scenario: Scenario, skus: SkuSet, site: Site, seed: int, down: DownPeriods | None
    ) -> None:
        self._scenario = scenario
        self._skus = skus
        self._site = site
        self._seed = seed
        self._gone_s = scenario.time_of_day_s
        self._openings = Openings(down, self._gone_s)
        self._stream: OrderStream | BundleStream | None = None

    def intake(self, record: Callable[[T], None] | None) -> Intake[T]:
        """Return the intake; `record`, if given, is called with each arrival."""
        processes = [*self._regular(), *self._batches()]
        return Intake(processes, record, self._stream, self._finish())

    def _finish(self) -> Callable[[T], T] | None:
        """Return a function that transforms each arrival; None: no transformation."""
        return None

    @abstractmethod
    def _regular(self) -> Iterator[Process[T]]:
        """Yield the processes of regular arrivals."""

    @abstractmethod
    def _batches(self) -> Iterator[Process[T]]:
        """Yield the processes of batches, if there are any."""

    def _arrivals(
        self, profile: AnyRate, per_h: float, scale: float, stream: Stream
    ) -> Iterator[Candidate]:
        """Return the possible arrivals of a Poisson process up to the end of the run."""
        rate = rate_of(profile, per_h, scale, self._gone_s, self._seed)
        until_us = first_us(self._scenario.warmup_s + self._scenario.duration_s)
        return Poisson(rate, Substreams(self._seed, stream), self._openings, until_us)

    def _at_times(self, times_us: Iterable[int]) -> Iterator[Candidate]:
        """Return candidates at given times; those in a down period are postponed to its end."""
        return map(_candidate, enumerate(map(self._openings.open_from_us, times_us)))


def _candidate(which: tuple[int, int]) -> Candidate:
    return Candidate(*which)
