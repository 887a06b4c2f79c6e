"""Sequential halving: finds the best of several decisions by trials."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf, nan
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.asks import Answer

if TYPE_CHECKING:
    from rmfs.control.lookahead import Trials


@dataclass(frozen=True, eq=False)
class Comparison:
    """Decisions to compare by trials: simulations of each decision in randomly drawn futures.

    The first decision is that of the base rule; it is the default. In every trial, the base rule
    also makes all later decisions of the same problem.

    Attributes
    ----------
    trials
        Function that tries out one decision in one of the futures (`rmfs.control.lookahead`).
    count
        Number of decisions.
    samples
        Maximum number of futures in which each decision is tried.
    instants
        Budget of all trials: once this many instants (times at which something happens) have been
        simulated, no further future is tried.
    certainty
        Another decision replaces the first only if its mean advantage over the first exceeds this
        many standard errors.
    state
        Numbers that identify the state of the run; they enter the hash of the comparison.
    """

    trials: Trials
    count: int
    samples: int
    instants: int
    certainty: float
    state: tuple[float, ...] = field(default=())

    def digested(self) -> tuple[object, ...]:
        """Return the values from which the hash of the comparison is computed."""
        return self.count, self.samples, self.instants, self.certainty, self.state


def solve(question: Comparison) -> Answer:
    """Find the decision whose trials have the greatest mean value, by sequential halving.

    First, all decisions are tried in one future. Each further round doubles the number of futures
    tried so far. After each round, the base rule's decision and the better half of the others are
    kept. The trials end early if, in the futures tried so far, no other decision that is kept has a
    greater mean value than the base rule's decision. In the end, the best of the others is chosen
    if its mean advantage over the base rule's decision exceeds `certainty` standard errors;
    otherwise, the base rule's decision is chosen. If only one future was tried, the standard error
    is unknown, and the base rule's decision is chosen unless `certainty` is 0. Source: Karnin,
    Koren and Somekh (2013), "Almost optimal exploration in multi-armed bandits".

    Returns
    -------
    Answer
        `row` of the solution is the index of the decision; the objective is minus its mean value.
        Work is the number of simulated instants.
    """
    values: dict[int, list[float]] = {row: [] for row in range(question.count)}
    alive, tried, spent, round_end = list(values), 0, 0, 1
    while tried < question.samples and spent < question.instants and len(alive) > 1:
        for row in alive:
            one = question.trials(row, tried)
            values[row].append(one.value)
            spent += one.instants
        tried += 1
        if tried == round_end:
            round_end *= 2
            ranked = sorted(alive[1:], key=lambda row: -_advantage(values, row)[0])
            alive = [0, *ranked[: (len(ranked) + 1) // 2]]
            if all(_advantage(values, row)[0] <= 0.0 for row in alive[1:]):
                break
    best = max(alive[1:], key=lambda row: _advantage(values, row)[0], default=0)
    if best:
        mean, error = _advantage(values, best)
        if not mean > (question.certainty * error if question.certainty else 0.0):
            best = 0
    value = float(np.mean(values[best])) if values[best] else 0.0
    return Answer({"row": best}, -value, -inf, "compared", "rollout", work=float(spent))


def _advantage(values: dict[int, list[float]], row: int) -> tuple[float, float]:
    """Return mean and standard error of the advantage over the first decision.

    With one value, the standard error is nan.
    """
    gain = np.array(values[row]) - np.array(values[0][: len(values[row])])
    mean = float(gain.mean())
    if len(gain) < 2:
        return mean, nan
    return mean, float(gain.std(ddof=1) / np.sqrt(len(gain)))
