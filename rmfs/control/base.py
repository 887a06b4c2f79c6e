"""The base class of all controllers."""

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
    """Base class of controller parameters; the string below a field is its documentation."""

    model_config = pydantic.ConfigDict(use_attribute_docstrings=True)


class RuleTables(Parameters):
    """Rules for some of the decision problems, each given as a table of a controllers file."""

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
    """The empty set of parameters, for rules that have none."""


P = TypeVar("P", bound=Parameters)


class Controller(Generic[P]):
    """Base class of all controllers.

    A controller is asked for decisions when one of its triggers occurs, or at a time of its own
    choice. It reads the view and changes nothing itself; its decisions are applied by the
    simulation. A controller that is installed during a run is asked for decisions immediately.

    Attributes
    ----------
    problem
        The decision problem that it solves.
    parameters_model
        Class of its parameters, from which their file format, documentation and use in `--set` are
        derived.
    triggers
        Events after which controllers of the problem are asked for decisions (Merschformann, Xie
        and Li 2018, table 1); a rule may define other events, or none.
    subscriptions
        Further events after which this controller is asked for decisions.
    hears
        Events that are passed to `hear` immediately, even if no decision is due.
    waits_for
        Problems whose decisions it waits for; two rules that wait for each other are refused.
    decides
        Further problems that it decides; for each of them, a dummy (`is_dummy`) must be selected.
    is_dummy
        Whether it decides nothing and leaves the problem to another controller.
    optimisers
        Modules with the functions that answer its questions (`rmfs.control.asks`); required of
        controllers that ask optimisers.
    goes_on
        Whether `answered`, if it is called again with the same call, continues where it was
        interrupted (see `Call.left`). Questions to a program outside the simulation cause such
        interruptions. If PPS, PSA or repositioning is decided outside the simulation, this
        must be true for a TA rule that asks optimisers.
    looks_ahead
        Whether it needs the attribute `lookahead`, with which it can try out decisions.
    in_flight
        Number of its questions that are waiting for an answer.
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
        """Return the simulated time, in s, by which the controller must be asked again.

        If the time is inf, the controller is asked only after events. The simulation calls this
        method each time after it has asked the controller.
        """
        return inf

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Process an event listed in `hears`; `Trigger` describes the subject of each event."""

    def answered(self, call: Call) -> Iterator[Any]:
        """Yield, as `decide` does, those decisions of a solution that are still valid.

        This method is called when a question has been answered, even if there is no solution. If
        `goes_on` is true, it may be called again with the same call after an interruption. An
        implementation adds to `call.stale` the number of decisions that are no longer valid. If a
        decision does not come from this answer, the implementation wraps the decision in
        `rmfs.control.asks.By`. The base class yields no decisions.
        """
        return iter(())

    def is_modelled(self, decision: Any) -> bool:
        """Return whether a decision is of a kind that the controller's optimisers make.

        Only such decisions are counted, either as based on a solution or as made by the
        controller's own rule. A task that was prepared by `rmfs.control.decisions.Prepare` is
        counted when it is carried out.
        """
        return not getattr(decision, "is_ahead", False)

    def draw(self, count: int) -> int:
        """Draw an integer from 0 to `count` - 1, all equally likely."""
        return int(self.rng.random() * count)
