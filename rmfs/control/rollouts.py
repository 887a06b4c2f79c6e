"""Shared parts of rollout rules, which compare decisions by simulation before they choose one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import pydantic

from rmfs.config import Table
from rmfs.control import legality
from rmfs.control.asks import Ask
from rmfs.control.base import Controller, Parameters
from rmfs.control.choices import choose
from rmfs.control.halving import Comparison, solve
from rmfs.control.lookahead import Goal
from rmfs.control.problems import Problem, Trigger
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy as np

    from rmfs.control.asks import Call
    from rmfs.control.view import View

AtLeastOne = Annotated[int, pydantic.Field(ge=1)]
Positive = Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)]


class RolloutParameters(Parameters):
    """Parameters of rollout rules."""

    base: Table = pydantic.Field(default_factory=dict)
    """The rule that makes the default decision and, in trials, all decisions after the tried one.
    It is given by a table, as in a controllers file. Default: the default rule of the problem."""
    candidates: AtLeastOne = 4
    """Maximum number of decisions that are compared, including the decision of the base rule."""
    samples: AtLeastOne = 4
    """Maximum number of randomly drawn futures in which each decision is tried; at least 2, unless
    `certainty` is 0."""
    horizon_s: Positive = 180.0
    """Duration of a trial in seconds of simulated time."""
    instants: AtLeastOne = 100_000
    """Limit on the effort of each comparison: once its trials have simulated this many instants
    (times at which something happens) in total, no further future is tried."""
    certainty: Annotated[float, pydantic.Field(ge=0)] = 1.0
    """Required certainty: another decision replaces that of the base rule only if its mean
    advantage in the trials, divided by the standard error of this mean, exceeds this number. With
    0, any positive mean is enough. Otherwise, at least two futures must have been tried, since the
    standard error of a single value is unknown."""
    goal: Goal = Goal()
    """Weights of what happens in a trial: units picked, orders completed, units stored, seconds by
    which orders are overdue, and metres driven. They define the value of the trial."""

    @pydantic.model_validator(mode="after")
    def _certain_of_something(self) -> RolloutParameters:
        if self.samples < 2 and self.certainty > 0:
            raise ValueError(
                "samples must be 2 or more, or certainty 0: the standard error of one sample is "
                f"unknown; given: samples = {self.samples}, certainty = {self.certainty:g}"
            )
        return self


class TriesOut:
    """Shared implementation of rollout rules.

    A rollout rule inherits from this class first, then from the base class of its problem.

    Attributes
    ----------
    base
        The base rule. It makes the default decision and, in the trials of decisions, all later
        decisions on the problem.
    """

    looks_ahead: ClassVar[bool] = True
    goes_on: ClassVar[bool] = True
    optimisers: ClassVar[tuple[str, ...]] = ("rmfs.control.halving",)
    base: Any
    view: View

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Pass an event to the base rule."""
        self.base.hear(trigger, subject)

    def next_event_s(self) -> float:
        """Return the simulated time, in s, at which the base rule must be called next; or inf."""
        return float(self.base.next_event_s())

    def best(self, call: Call) -> Iterator[Any]:
        """Yield the decision that the trials have selected, if it is still possible."""
        rows = [] if call.solution is None else [call.solution["row"]]
        for row in call.left("best", rows):
            chosen = call.ask.memo[row]
            if legality.reason(chosen, self.view):
                call.stale += 1
            else:
                yield chosen


def base_rule(
    problem: Problem, parameters: RolloutParameters, view: View, rng: np.random.Generator
) -> Any:
    """Create the base rule, which `parameters.base` selects.

    Raises
    ------
    InputError
        If no rule has this name, if its parameters are invalid, or if it cannot be a base rule
        (because it asks optimisers, is a dummy, or decides further problems).
    """
    choice = choose(problem, parameters.base, f"{problem}.base")
    rule = choice.controller
    if rule.optimisers or rule.is_dummy or rule.decides:
        raise InputError(
            f"{problem}.base: {choice.name} asks optimisers or decides with others: choose a rule "
            f"that decides {problem} alone"
        )
    return rule(choice.parameters, view, rng)


def question(
    controller: Controller[Any],
    base: Controller[Any],
    decisions: Sequence[Any],
    parameters: RolloutParameters,
) -> Ask[Comparison]:
    """Return a question that asks which of several decisions does best in trials.

    The first of `decisions` must be the decision of the base rule.
    """
    view = controller.view
    trials = controller.lookahead(
        controller.problem, decisions, base, parameters.horizon_s, parameters.goal
    )
    asked = Comparison(
        trials,
        len(decisions),
        parameters.samples,
        parameters.instants,
        parameters.certainty,
        (view.now_s, float(view.orders_created), float(len(view.orders))),
    )
    return Ask(solve, asked, {"candidates": len(decisions)}, list(decisions))
