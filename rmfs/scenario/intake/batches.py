"""Batches of orders or bundles; each batch arrives all at once, at a given time of a cycle."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

from rmfs.scenario.clock import Cycle, nearest_us

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.scenario.intake.state import State

T = TypeVar("T")


class Batch(NamedTuple):
    """Orders, or bundles, that arrive all at once, at the same time of every cycle.

    Attributes
    ----------
    time_s
        Time within the cycle, in s.
    lacks
        Function that returns whether the batch needs a further arrival. Its arguments are the state
        and the number of arrivals in the batch so far.
    """

    time_s: float
    lacks: Callable[[State, int], bool]


def add(time_s: float, number: int) -> Batch:
    """Return a batch of `number` arrivals, whatever the state."""
    return Batch(time_s, partial(_fewer_than, number))


def _fewer_than(number: int, _state: State, come: int) -> bool:
    return come < number


class Batches(Generic[T]):
    """An intake process that generates batches.

    Parameters
    ----------
    batches
        At least one batch.
    cycle_s, gone_s
        Length of the cycle, and time by which it has advanced at time zero, in s.
    make
        Function that creates an order or bundle. Its arguments are the number of the order or
        bundle (counted over all batches, from 0), the time in us and the state. If it returns None,
        because nothing can be created, the batch ends.
    """

    def __init__(
        self,
        batches: Sequence[Batch],
        cycle_s: float,
        gone_s: float,
        make: Callable[[int, int, State], T | None],
    ) -> None:
        self._batches = sorted(batches, key=lambda batch: batch.time_s)
        phases_us = [nearest_us(batch.time_s) for batch in self._batches]
        self._times = Cycle(cycle_s, gone_s).times_us(phases_us)
        self._make = make
        self._ordinal = 0
        self._go_on()

    def _go_on(self) -> None:
        """Proceed to the next batch."""
        self.next_us, which = next(self._times)
        self._lacks = self._batches[which].lacks
        self._come = 0

    def draw(self, now_us: int, state: State) -> T | None:
        """Return the next arrival of the batches whose time has come; None if there are no more."""
        while self.next_us <= now_us:
            if self._lacks(state, self._come):
                thing = self._make(self._ordinal, now_us, state)
                self._ordinal += 1
                if thing is not None:
                    self._come += 1
                    return thing
            self._go_on()
        return None
