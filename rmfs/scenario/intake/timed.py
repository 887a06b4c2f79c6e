"""Arrivals at times that are drawn or read from a file, independently of the state of a run."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Generic, TypeVar

from rmfs.errors import InputError
from rmfs.scenario.clock import NEVER_US
from rmfs.scenario.intake.thinning import Candidate, Poisson

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rmfs.scenario.intake.state import State
    from rmfs.scenario.parameters.rates import TiedTo

T = TypeVar("T")


class Timed(Generic[T]):
    """An intake process that generates arrivals at given times.

    Parameters
    ----------
    candidates
        The possible arrivals, sorted by time; `share` determines which are accepted.
    make
        Function that creates the arrival for an accepted candidate.
    share
        Function that returns the share of active stations. A candidate is accepted if this share
        exceeds the candidate's `needed_share`. If `share` is None, the rate is not tied to
        stations, and all candidates are accepted.
    """

    def __init__(
        self,
        candidates: Iterator[Candidate],
        make: Callable[[Candidate, State], T],
        share: Callable[[State], float] | None = None,
    ) -> None:
        self._candidates = candidates
        self._make = make
        self._share = share
        self._next = next(candidates, None)

    def redraw(self, now_us: int) -> None:
        """Redraw the time of the next arrival, even if none was to come before the end of the run.

        Raises
        ------
        InputError
            If arrival times are not drawn by a Poisson process, for example because they come from
            a file.
        """
        if isinstance(self._candidates, Poisson):
            self._candidates.redraw(now_us)
            self._next = next(self._candidates, None)
        elif self._next is not None:
            raise InputError(
                "looking ahead: not possible with orders or bundles from a file, as their future "
                "arrivals must be unknown; use drawn demand"
            )

    @property
    def next_us(self) -> int:
        """Time of the next candidate; `NEVER_US` if there is none."""
        return NEVER_US if self._next is None else self._next.time_us

    def draw(self, now_us: int, state: State) -> T | None:
        """Return the next arrival whose time has come; None if there is none."""
        while (candidate := self._next) is not None and candidate.time_us <= now_us:
            self._next = next(self._candidates, None)
            if self._share is None or candidate.needed_share < self._share(state):
                return self._make(candidate, state)
        return None


def at_zero(number: int) -> Iterator[Candidate]:
    """Yield `number` candidates, all at time zero."""
    return map(_at_zero, iter(range(number)))


def _at_zero(ordinal: int) -> Candidate:
    return Candidate(ordinal, 0)


def share_of(tied_to: TiedTo) -> Callable[[State], float] | None:
    """Return a function from a state to the share of active stations.

    The result is None if `tied_to` is "nothing".
    """
    if tied_to == "pick-stations":
        return attrgetter("active_pick_share")
    if tied_to == "replenishment-stations":
        return attrgetter("active_replenishment_share")
    return None
