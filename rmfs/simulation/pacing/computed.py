"""Reproducible pacing: questions are solved at once; answers take effect after a computed time."""

from __future__ import annotations

import traceback
from abc import ABC, abstractmethod
from math import ceil
from typing import TYPE_CHECKING

from rmfs.control.asks import checked
from rmfs.errors import InputError
from rmfs.random import Stream, generator
from rmfs.simulation.agenda import NEVER_US
from rmfs.simulation.pacing.errors import OptimiserError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rmfs.control.asks import Answer, Call
    from rmfs.simulation.pacing.settings import FixedPacing, WorkPacing

SECONDS_PER_UNIT = {
    "clarabel": 0.0002812,
    "columns": 0.9085,
    "cp_sat": 1.084,
    "highs": 0.0001898,
    "insertions": 2.91e-08,
    "min_cost_flow": 7.73e-07,
    "rounding": 2.476e-05,
    "rule": 2.989e-07,
    "scipy": 1.888e-09,
    "visits": 3.98e-09,
}
"""Seconds per unit of work of each back end, as measured by `python -m tests.tools.calibrate` on an
AMD EPYC on 2026-11-22 and 23 (results/published/seconds-per-unit.md)."""

SECONDS_PER_CALL = {
    "clarabel": 0.0,
    "columns": 0.004539,
    "cp_sat": 0.003471,
    "highs": 0.0,
    "insertions": 0.000356,
    "min_cost_flow": 0.0002342,
    "rounding": 0.001733,
    "rule": 0.0001915,
    "scipy": 5.426e-05,
    "visits": 3.114e-05,
}
"""Additional seconds per call, from the same measurement; 0 for other back ends."""

SECONDS_PER_ENTRY = {
    "clarabel": 0.0,
    "columns": 0.0,
    "cp_sat": 4.381e-06,
    "highs": 2.424e-05,
    "insertions": 1.02e-08,
    "min_cost_flow": 0.0,
    "rounding": 0.0,
    "rule": 6.158e-06,
    "scipy": 0.0,
    "visits": 6.673e-09,
}
"""Seconds per nonzero entry of the solver's model (`Answer.built`), from the same measurement; 0
for other back ends."""


SECONDS_PER_INSTANT = 8e-5
"""Seconds per simulated instant of a trial (back end `rollout`), including copies of the run.
Measured with the POA rule `rollout` at the site `small-arrivals` on the same machine (2.2 s for
27,600 instants)."""


class Computed(ABC):
    """Base class: `ask` solves the question itself, in the process of the simulation."""

    waits = False

    def begin(self, modules: Iterable[str], give: Callable[[Call, int], None]) -> None:
        """Store the callback for answers."""
        self._give = give

    def ask(self, call: Call) -> None:
        """Solve the question, and let its answer take effect after the computed time.

        Raises
        ------
        OptimiserError
            If the optimiser fails. The failure may be due to chance, so a run that continued
            without the answer would not be reproducible.
        """
        ask = call.ask
        try:
            answer = checked(ask.solve(ask.question))
        except Exception as error:
            raise OptimiserError(
                f"{call.problem} ({type(call.controller).__name__}) at "
                f"{call.requested_us / 1e6:.3f} s: {type(error).__name__}: {error} "
                f"({_place(error)})"
            ) from error
        call.answer = answer
        self._give(call, call.requested_us + ceil(self.seconds(answer) * 1e6))

    def limit_us(self, now_us: int) -> int:
        """Return no limit, as every question is answered as soon as it is asked."""
        return NEVER_US

    def end(self) -> None:  # noqa: B027 - not for subclasses: there is nothing to end
        """Do nothing, as there are no resources to release."""

    @abstractmethod
    def seconds(self, answer: Answer) -> float:
        """Return the simulated time in s from a question until this answer to it takes effect."""


def _place(error: Exception) -> str:
    """Return file and line of the innermost call that is not in an installed package."""
    calls = traceback.extract_tb(error.__traceback__)
    own = [call for call in calls if "site-packages" not in call.filename]
    call = (own or calls)[-1]
    return f"{call.filename}, line {call.lineno}"


class Instant(Computed):
    """Answers take effect at the instant of their question."""

    def seconds(self, answer: Answer) -> float:
        """Return 0."""
        return 0.0


class Work(Computed):
    """Answers take simulated time according to the work of the solver.

    The time consists of a constant per call, and of amounts proportional to the solver's work and
    to the number of nonzeros of its model.
    """

    def __init__(self, settings: WorkPacing) -> None:
        self._per_call = settings.seconds_per_call
        self._per_unit = settings.seconds_per_unit
        self._per_entry = settings.seconds_per_entry

    def seconds(self, answer: Answer) -> float:
        """Return the simulated time that an answer takes, in s, from its work and model size.

        Raises
        ------
        InputError
            If the time per unit of work is unknown for the answer's back end.
        """
        unit, call = self._per_unit, self._per_call
        if isinstance(unit, dict):
            rates = SECONDS_PER_UNIT | {"rollout": SECONDS_PER_INSTANT} | unit
            if answer.backend not in rates:
                raise InputError(
                    f"pacing work: seconds_per_unit.{answer.backend} is missing; known: "
                    f"{', '.join(rates)}"
                )
            unit = rates[answer.backend]
        if call is None:
            call = SECONDS_PER_CALL.get(answer.backend, 0.0)
        entry = self._per_entry
        if entry is None:
            entry = SECONDS_PER_ENTRY.get(answer.backend, 0.0)
        return call + answer.work * unit + answer.built * entry


class Fixed(Computed):
    """Answers take a constant simulated time, or random times from a distribution."""

    def __init__(self, settings: FixedPacing, seed: int) -> None:
        self._seconds = settings.seconds
        self._rng = generator(seed, Stream.PACING)

    def seconds(self, answer: Answer) -> float:
        """Return the constant time, or a newly drawn time, in s."""
        if isinstance(self._seconds, float):
            return self._seconds
        return float(self._seconds.quantile(self._rng.random()))
