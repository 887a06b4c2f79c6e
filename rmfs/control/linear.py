"""Linear rules, which choose the candidate with the greatest weighted sum of features.

The features are the scaled ones of `rmfs.control.features`; `rmfs learn` trains the weights. The
terms of a sum are added in a fixed order, so that runs are reproducible on every machine.
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
"""Initial weights of scaled features, by kind of question, where `RANKINGS` would be a bad rule."""


def default_weights(kind: str) -> Weights:
    """Return the initial weights of the scaled features of a kind of question.

    If `STARTS` has weights for this kind, these are returned. Otherwise, each weight in
    `rmfs.control.features.RANKINGS` is multiplied by the scale of its feature. Features without a
    weight in `RANKINGS` get 0.
    """
    if kind in STARTS:
        return {name: STARTS[kind].get(name, 0.0) for name in COLUMNS[kind]}
    ranking = RANKINGS[kind]
    return {name: ranking.get(name, 0.0) * SCALES[name] for name in COLUMNS[kind]}


def checked(kind: str, weights: Mapping[str, float]) -> Weights:
    """Return a weight for every feature of a kind of question; weights not given are 0.

    Raises
    ------
    ValueError
        If a weight is given for an unknown feature.
    """
    unknown = [name for name in weights if name not in COLUMNS[kind]]
    if unknown:
        raise ValueError(
            f"{unknown[0]} is not a feature of {kind}; valid: {', '.join(COLUMNS[kind])}"
        )
    return {name: float(weights.get(name, 0.0)) for name in COLUMNS[kind]}


def best_of(
    candidates: Candidates,
    kind: str,
    view: View,
    weights: Weights,
    among: NDArray[np.intp] | None = None,
) -> int:
    """Return the row with the greatest weighted sum of features; -1 if there are no rows.

    Ties go to the row that comes first in `among`.

    Parameters
    ----------
    among
        Rows to choose from. Default: all.
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
    """Return the weighted sum of the scaled features of each row, in the order of `rows`.

    Parameters
    ----------
    rows
        Rows of the candidates. Default: all.
    """
    columns = {name: values[rows] for name, values in numbers(candidates, kind, view).items()}
    names = list(weights)
    features = matrix(columns, names)
    score = np.zeros(len(features))
    for place, name in enumerate(names):
        score += weights[name] * features[:, place]
    return score
