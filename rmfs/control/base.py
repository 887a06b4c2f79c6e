"""What all controllers have in common."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import pydantic

from rmfs.config import Model, Table

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.asks import Call
    from rmfs.control.lookahead import LookAhead
    from rmfs.control.problems import Problem, Trigger
    from rmfs.control.view import View


class Parameters(Model):
    """Base of the parameters of controllers; the text below a field explains it to users."""

    model_config = pydantic.ConfigDict(use_attribute_docstrings=True)


class RuleTables(Parameters):
    """Rules for some problems, each a table as in a controllers file."""

    poa: Table | None = None
    """The rule for pick order assignment."""
    roa: Table | None = None
    """The rule for replenishment order assignment."""
    rps: Table | None = None
    """The rule for replenishment pod selection."""
    pps: Table | None = None
    """The rule for pod selection."""
    psa: Table | None = None
    """The rule for pod storage assignment."""
    ta: Table | None = None
    """The rule for task allocation."""
    sa: Table | None = None
    """The rule for station activation."""
    mm: Table | None = None
    """The rule for method management."""
    pp: Table | None = None
    """The rule for path planning."""
    repositioning: Table | None = None
    """The rule for repositioning."""
    ca: Table | None = None
    """The rule for charge assignment."""


class NoParameters(Parameters):
    """A rule that has nothing to set."""


P = TypeVar("P", bound=Parameters)


class Controller(Generic[P]):
    """Base of all controllers.

    A controller is asked for decisions when one of its triggers happened, or at the time it names
    itself. It reads the view and changes nothing: its decisions do. A new controller is installed
    with `START`, at the beginning of a run or in the middle of it.

    Attributes
    ----------
    problem
        The decision problem it solves.
    parameters_model
        The model of its parameters: file format, `--set` and documentation come from it.
    triggers
        Events after which every controller of the problem is asked (paper, table 1).
    subscriptions
        Further events after which this controller wants to be asked.
    hears
        Events of which `hear` is told at once, decision or not.
    waits_for
        Problems whose decision it waits for; two rules that wait for each other are refused.
    decides
        Further problems whose decisions it takes; a dummy has to stand in for each of them.
    is_dummy
        Whether it decides nothing and leaves the decision to another controller.
    optimisers
        Modules with the functions that solve its questions (`rmfs.control.asks`); a controller
        that asks optimisers names one at least.
    goes_on
        Whether `answered` may be called again with a call whose answer it was carrying out when
        somebody outside was asked: it then goes on where it was (`Call.left`). To be said by rules
        for TA that ask optimisers; without it PPS, PSA and repositioning cannot be decided outside.
    looks_ahead
        Whether it is given `lookahead`, with which it tries decisions out.
    in_flight
        How many of its questions wait for an answer.
    """

    problem: ClassVar[Problem]
    parameters_model: ClassVar[type[Parameters]] = NoParameters
    triggers: ClassVar[frozenset[Trigger]] = frozenset()
    subscriptions: ClassVar[frozenset[Trigger]] = frozenset()
    hears: ClassVar[frozenset[Trigger]] = frozenset()
    waits_for: ClassVar[frozenset[Problem]] = frozenset()
    decides: ClassVar[frozenset[Problem]] = frozenset()
    is_dummy: ClassVar[bool] = False
    optimisers: ClassVar[tuple[str, ...]] = ()
    goes_on: ClassVar[bool] = False
    looks_ahead: ClassVar[bool] = False
    lookahead: LookAhead
    in_flight: int = 0

    def __init__(self, parameters: P, view: View, rng: np.random.Generator) -> None:
        self.parameters = parameters
        self.view = view
        self.rng = rng

    def next_event_s(self) -> float:
        """When it wants to be asked at the latest; looked up after each time it was asked."""
        return inf

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Take note of an event of `hears`; the subject is as described at the trigger."""

    def answered(self, call: Call) -> Iterator[Any]:
        """Yield the decisions of a solution that still hold, as `decide` yields its own.

        It is called once for each question, also if there is no solution. Decisions that no longer
        hold are to be counted in `call.stale`; one that does not come from this answer says so
        (`rmfs.control.asks.By`). Here: no decisions.
        """
        return iter(())

    def is_modelled(self, decision: Any) -> bool:
        """Whether a decision is of a kind that its optimisers take: only those are counted.

        What is prepared ahead counts when it is done.
        """
        return not getattr(decision, "is_ahead", False)

    def draw(self, count: int) -> int:
        """Draw a number from 0 to `count` - 1, all equally likely."""
        return int(self.rng.random() * count)
