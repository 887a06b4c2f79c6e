"""POA rollout: makes the base rule's decision, or another that did better in simulated trials."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.control.candidates import candidates_for
from rmfs.control.decisions import AssignOrder
from rmfs.control.features import best_rows, unscaled, weights_of
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.problems import Problem
from rmfs.control.questions import Question
from rmfs.control.rollouts import RolloutParameters, TriesOut, base_rule, question

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.asks import Call
    from rmfs.control.view import View


class Rollout(TriesOut, PickOrderAssignment[RolloutParameters]):
    """Tries out several assignments by simulation before it assigns an order.

    The base rule makes a default decision. This decision and the best other pairs of order and
    station (by `rmfs.control.features.RANKINGS`) are tried in copies of the run, in which the base
    rule makes all later assignments. The decision that did best replaces the default decision if
    its advantage is certain enough (`certainty`). The pacing determines how much simulated time
    passes in the run itself while trials are computed; meanwhile, no order is assigned.
    """

    parameters_model = RolloutParameters

    def __init__(self, parameters: RolloutParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self.base = base_rule(Problem.POA, parameters, view, rng)
        self.subscriptions = self.base.subscriptions  # type: ignore[misc]
        self.hears = self.base.hears  # type: ignore[misc]

    def decide(self) -> Iterator[Any]:
        """Yield the base rule's decision or, if there are others, ask which of all is the best."""
        while not self.in_flight:
            first = next(iter(self.base.decide()), None)
            if first is None:
                return
            others = self._others(first) if isinstance(first, AssignOrder) else []
            if others:
                yield question(self, self.base, [first, *others], self.parameters)
            else:
                yield first

    def answered(self, call: Call) -> Iterator[Any]:
        """Yield the best decision if it is still valid.

        If simulated time has passed since the question was asked, go on with `decide`.
        """
        yield from self.best(call)
        if call.completed_us > call.requested_us:
            yield from self.decide()

    def _others(self, first: AssignOrder) -> list[AssignOrder]:
        found = candidates_for(self.view, Question(Problem.POA, "turn"))
        if not len(found):
            return []
        count = self.parameters.candidates
        rows = best_rows(unscaled(found, "poa", self.view), weights_of("poa"), count)
        in_stock = found.columns["in_stock"]
        others = [found[int(row)] for row in rows if in_stock[row]]
        return [one for one in others if one != first][: count - 1]
