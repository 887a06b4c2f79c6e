"""Looking ahead: what a controller may ask about decisions it has not taken.

A controller that sets `looks_ahead` is given a `LookAhead`. It names some decisions and gets
trials: copies of the run, in each of which one of them is taken and a base rule goes on. The future
of a copy is drawn anew, from streams of its own, the same for all decisions that are compared: what
will really come is not in it. A controller never has the run itself.
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
    """What a trial is worth: amounts within its horizon, each times a weight."""

    units: float = 1.0
    """Of a unit picked at the begin of the horizon; it falls to 0 at its end."""
    orders: float = 0.0
    """The same of an order completed."""
    units_stored: float = 0.0
    """The same of a unit stored: what is picked has to be stored sometime."""
    overdue_s: float = pydantic.Field(default=0.0, ge=0)
    """Of a second that an order is overdue within the horizon; it is subtracted."""
    distance_m: float = pydantic.Field(default=0.0, ge=0)
    """Of a metre driven; it is subtracted."""


class Tried(NamedTuple):
    """How a trial went.

    Attributes
    ----------
    value
        What it was worth.
    instants
        At how many instants something happened: the work it was.
    """

    value: float
    instants: int


class Trials(Protocol):
    """Decisions that can be tried out."""

    def __call__(self, which: int, sample: int) -> Tried:
        """Try one of the decisions.

        Parameters
        ----------
        which
            Its place in the list.
        sample
            Which of the futures: trials of one number meet the same.
        """
        ...


class LookAhead(Protocol):
    """What a controller that looks ahead is given."""

    def __call__(
        self,
        problem: Problem,
        decisions: Sequence[Any],
        base: Controller[Any],
        horizon_s: float,
        goal: Goal,
    ) -> Trials:
        """Prepare trials of some decisions, as the run is now.

        Parameters
        ----------
        base
            The rule that takes over the problem after the decision.
        horizon_s
            How long each trial lasts.

        Raises
        ------
        InputError
            If the future cannot be drawn anew (orders come from a file), or the run cannot be
            copied (pacing wall).
        """
        ...
