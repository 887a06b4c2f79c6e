"""MM scheduled: exchanges controllers at given times."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.choices import check_together
from rmfs.control.decisions import Exchange
from rmfs.control.mm import MethodManagement
from rmfs.control.mm.rules import Rules
from rmfs.control.problems import Problem
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import numpy as np

    from rmfs.control.choices import Choice
    from rmfs.control.view import View


class PlannedExchange(Rules):
    """Rules to be installed together at a given time."""

    at_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] | None = None
    """Simulated time of the exchange in seconds; give either this or `at_share`."""
    at_share: Annotated[float, pydantic.Field(ge=0, le=1)] | None = None
    """Time of the exchange as a share of the run, warm-up included; give either this or `at_s`."""

    @pydantic.model_validator(mode="after")
    def _one_time(self) -> PlannedExchange:
        if (self.at_s is None) == (self.at_share is None):
            raise ValueError("must have exactly one of at_s and at_share")
        return self

    def time_s(self, end_s: float) -> float:
        """Return the simulated time in s of the exchange in a run that ends at `end_s`."""
        if self.at_share is not None:
            return self.at_share * end_s
        assert self.at_s is not None
        return self.at_s


class ScheduledParameters(Parameters):
    """Parameters of MM scheduled."""

    exchanges: Annotated[tuple[PlannedExchange, ...], pydantic.Field(min_length=1)]
    """The exchanges in order of time, for example `{ at_share = 0.5, psa = { name = "nearest" } }`.
    Each has a table for each rule to install, and a time: either `at_s` (in s of simulated time) or
    `at_share` (a share of the whole run, warm-up included)."""


class Scheduled(MethodManagement[ScheduledParameters]):
    """Exchanges controllers of any problem at given times.

    The rules of one exchange are installed together. Parameters that are not given have their
    default values.
    """

    parameters_model = ScheduledParameters

    def __init__(
        self, parameters: ScheduledParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        planned = [(entry.time_s(view.end_s), entry) for entry in parameters.exchanges]
        # a rule installed during the run does not catch up on past exchanges
        self._left = [entry for entry in planned if entry[0] >= view.now_s]

    def decide(self) -> Iterator[Exchange]:
        """Yield the exchanges that are due."""
        while self._left and self._left[0][0] <= self.view.now_s:
            for choice in self._left.pop(0)[1].choices():
                yield Exchange(choice)

    def next_event_s(self) -> float:
        """Simulated time in s of the next exchange; inf if none is left."""
        return self._left[0][0] if self._left else inf

    @classmethod
    def check(cls, choices: Mapping[Problem, Choice], source: str) -> None:
        """Check that exchanges are in order of time, and that each one leads to compatible rules.

        Raises
        ------
        InputError
            If one of these conditions is violated, or some exchanges have `at_s` and others
            `at_share`.
        """
        given = choices[Problem.MM].parameters
        assert isinstance(given, ScheduledParameters)
        shares = [entry.at_share for entry in given.exchanges]
        if None in shares and any(share is not None for share in shares):
            raise InputError(
                f"{source}: mm.exchanges: either all entries must have at_s, or all at_share"
            )
        times = [entry.time_s(1.0) for entry in given.exchanges]
        if times != sorted(times):
            raise InputError(f"{source}: mm.exchanges: must be in chronological order")
        present = dict(choices)
        for number, entry in enumerate(given.exchanges):
            present |= {choice.problem: choice for choice in entry.choices()}
            check_together(present, f"{source}: mm.exchanges.{number}")
