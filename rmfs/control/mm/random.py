"""MM random: periodically installs one of several sets of rules, chosen at random."""

from __future__ import annotations

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


class RandomParameters(Parameters):
    """Parameters of MM random."""

    period_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 7200.0
    """Length of a period in seconds; at its end, an alternative is installed."""
    alternatives: Annotated[tuple[Rules, ...], pydantic.Field(min_length=1)] = (
        Rules(psa={"name": "nearest"}),
        Rules(psa={"name": "random"}),
        Rules(psa={"name": "station-based"}),
        Rules(psa={"name": "turnover"}),
    )
    """The alternatives. Each is a set of tables, one for each rule to install, for example
    `{ psa = { name = "random" } }`; the rules of a set are installed together."""


class RandomExchange(MethodManagement[RandomParameters]):
    """At the end of each period, installs one of the `alternatives`, all with equal probability.

    If the drawn alternative is already installed, its rules start anew.
    """

    parameters_model = RandomParameters

    def __init__(self, parameters: RandomParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._start_s = view.now_s
        self._periods = 1

    def decide(self) -> Iterator[Exchange]:
        """Yield, for each period ended since the last call, the exchanges of one alternative."""
        while self.next_event_s() <= self.view.now_s:
            self._periods += 1
            alternatives = self.parameters.alternatives
            for choice in alternatives[self.draw(len(alternatives))].choices():
                yield Exchange(choice)

    def next_event_s(self) -> float:
        """Simulated time in s at which the current period ends."""
        return self._start_s + self._periods * self.parameters.period_s

    @classmethod
    def check(cls, choices: Mapping[Problem, Choice], source: str) -> None:
        """Check that each alternative is compatible with the rules of the other problems.

        The rules of the other problems are the initial ones, or those that another alternative
        has installed.

        Raises
        ------
        InputError
            If an alternative is not compatible with these rules; if it contains a rule that decides
            several problems; or if it contains a dummy (which leaves its problem to another rule).
        """
        given = choices[Problem.MM].parameters
        assert isinstance(given, RandomParameters)
        for number, entry in enumerate(given.alternatives):
            where = f"{source}: mm.alternatives.{number}"
            for choice in entry.choices():
                rule = choice.controller
                if rule.is_dummy or rule.decides:
                    raise InputError(
                        f"{where}: {choice.problem} {choice.name} must be combined with others; "
                        "MM random exchanges only rules that decide a single problem"
                    )
            new = {choice.problem: choice for choice in entry.choices()}
            check_together({**choices, **new}, where)
            # what another draw has installed stays for the problems that this one leaves out
            for other, drawn in enumerate(given.alternatives):
                left = {choice.problem: choice for choice in drawn.choices()}
                check_together({**choices, **left, **new}, f"{where} after {other}")
