"""Look-ahead: lets a controller try out decisions before it makes one.

A controller that sets `looks_ahead` is given a `LookAhead`. The controller passes some decisions to
it and gets a function that tries them out. In a trial, a copy of the run is simulated: one of the
decisions is applied, and a base rule makes the later decisions of the same problem. The future of a
copy is drawn anew, from separate random streams, so it reveals nothing about the real future. All
compared decisions can be tried in the same futures. A controller never has access to the run
itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import pydantic

from rmfs.control.base import Parameters

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.base import Controller
    from rmfs.control.problems import Problem


class Goal(Parameters):
    """Weights of what happens within the horizon of a trial; they define the trial's value."""

    units: float = 1.0
    """Value of a unit picked at the start of the horizon; it falls linearly to 0 at the end."""
    orders: float = 0.0
    """Value of an order completed at the start of the horizon; it falls linearly to 0 at the
    end."""
    units_stored: float = 0.0
    """Value of a unit stored at the start of the horizon; it falls linearly to 0 at the end.
    With 0, replenishment adds no value, although picked units must be replaced some time."""
    overdue_s: float = pydantic.Field(default=0.0, ge=0)
    """Cost of each second by which an order is overdue within the horizon."""
    distance_m: float = pydantic.Field(default=0.0, ge=0)
    """Cost of each metre driven."""


class Tried(NamedTuple):
    """The result of a trial.

    Attributes
    ----------
    value
        Value of the trial, as defined by the `Goal`.
    instants
        Number of simulated instants (times at which something happens), as a measure of effort.
    """

    value: float
    instants: int


class Trials(Protocol):
    """Function that tries out one of several decisions in one of many futures."""

    def __call__(self, which: int, sample: int) -> Tried:
        """Try out a decision in a future.

        Parameters
        ----------
        which
            Index of the decision.
        sample
            Number of the future; trials with the same number share it.
        """
        ...


class LookAhead(Protocol):
    """Function that prepares trials of decisions; given to controllers that set `looks_ahead`."""

    def __call__(
        self,
        problem: Problem,
        decisions: Sequence[Any],
        base: Controller[Any],
        horizon_s: float,
        goal: Goal,
    ) -> Trials:
        """Prepare trials of some decisions from the current state of the run.

        Parameters
        ----------
        problem
            The problem that the decisions solve.
        decisions
            The decisions to be compared.
        base
            Rule that decides the problem after the tried decision.
        horizon_s
            Simulated duration of a trial in s.
        goal
            Defines the value of a trial.

        Raises
        ------
        InputError
            If the future cannot be drawn anew (orders or bundles come from a file), or the run
            cannot be copied (the pacing, or that of path planning, is `wall`).
        """
        ...
