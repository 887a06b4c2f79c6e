"""What linear rules have in common: weights of features, and the choice of the greatest sum.

The features are those of `rmfs.control.features`, scaled; `rmfs learn` finds weights. Sums are
taken feature by feature in a fixed order, so that a run repeats on every machine.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.features import COLUMNS, RANKINGS, SCALES, matrix, numbers

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from rmfs.control.candidates import Candidates
    from rmfs.control.view import View

Weights = dict[str, float]

ALL = slice(None)


STARTS: dict[str, Weights] = {
    "ta": {
        **{"work": 10.0, "pick": 1.0, "store": 5.0, "rest": -10.0},
        **{"away_s": -1.0, "units": 1.0, "robots": -5.0},
    },
}
"""Weights of scaled features that make a rule, where those of the ranking do not."""


def default_weights(kind: str) -> Weights:
    """Return the weights with which a rule begins: those of the ranking, if it has none."""
    if kind in STARTS:
        return {name: STARTS[kind].get(name, 0.0) for name in COLUMNS[kind]}
    ranking = RANKINGS[kind]
    return {name: ranking.get(name, 0.0) * SCALES[name] for name in COLUMNS[kind]}


def checked(kind: str, weights: Mapping[str, float]) -> Weights:
    """Return weights of all features of a kind of question; those not named are 0.

    Raises
    ------
    ValueError
        If there is no such feature.
    """
    unknown = [name for name in weights if name not in COLUMNS[kind]]
    if unknown:
        raise ValueError(f"{unknown[0]} is no feature here; valid: {', '.join(COLUMNS[kind])}")
    return {name: float(weights.get(name, 0.0)) for name in COLUMNS[kind]}


def best_of(
    candidates: Candidates,
    kind: str,
    view: View,
    weights: Weights,
    among: NDArray[np.intp] | None = None,
) -> int:
    """Return the row with the greatest weighted sum, of equals the first; -1 without any.

    Parameters
    ----------
    among
        Rows to choose from; by default all.
    """
    rows = np.arange(len(candidates)) if among is None else among
    if not len(rows):
        return -1
    return int(rows[scores(candidates, kind, view, weights, rows).argmax()])


def scores(
    candidates: Candidates,
    kind: str,
    view: View,
    weights: Weights,
    rows: NDArray[np.intp] | slice = ALL,
) -> NDArray[np.float64]:
    """Return the weighted sum of each candidate, or of some rows of them, shape (C,)."""
    columns = {name: values[rows] for name, values in numbers(candidates, kind, view).items()}
    names = list(weights)
    features = matrix(columns, names)
    score = np.zeros(len(features))
    for place, name in enumerate(names):
        score += weights[name] * features[:, place]
    return score
