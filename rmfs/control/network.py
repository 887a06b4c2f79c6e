"""Network rules, which choose the candidate that a small neural network scores highest.

All candidates are scored by the same weights, so a score does not depend on the order of the
candidates. The inputs are the scaled features of the candidate (`rmfs.control.features`) and of the
warehouse (`rmfs.control.overview`). `rmfs learn-network` trains the weights. Evaluating a network
needs no machine-learning library. The terms of each sum are added in a fixed order, and only
operations that give the same result on every machine are used, so runs are reproducible everywhere.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pydantic

from rmfs.config import Model
from rmfs.control.base import Parameters
from rmfs.control.features import COLUMNS, LIMIT, SCALES, unscaled, weights_of
from rmfs.control.overview import GLOBAL_FEATURES, overview
from rmfs.traffic._core import offered  # the package has one compiled library

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.control.answers import Candidates
    from rmfs.control.view import View

CANDIDATES = 16
"""Default of the number of candidates that are scored."""

CONSTANT = "constant"
"""Key of the constant term of the score of declining."""

WHOLE = tuple(feature.name for feature in GLOBAL_FEATURES)
PREFIX = "all."
"""Prefix of the features of the warehouse in `Network.inputs`."""

STARTS: dict[str, tuple[dict[str, float], float | None]] = {
    "poa": ({"in_stock": 32.0, "inbound_units": 4.0, "age_s": 2.0, "due_in_s": -2.0}, 6.0),
    "pick pod": ({"units": 10.0, "orders": 12.0, "reach_s": -2.0, "bring_s": -2.0}, -8.0),
    "replenishment pod": ({"bundles": 5.0, "reach_s": -2.0, "bring_s": -2.0}, -8.0),
    "next station": ({"away_s": -2.0, "units": 4.0}, None),
    "place": ({"away_s": -12.0, "back_s": -12.0}, None),
    "ta": (
        {
            **{"work": 10.0, "pick": 1.0, "store": 8.0, "move": -20.0, "rest": -10.0},
            **{"away_s": -4.0, "units": 1.0, "robots": -8.0},
        },
        -16.0,
    ),
}
"""For each kind of question, the weights of the features before training, and the score of
declining; None if a candidate must always be chosen."""

Row = tuple[pydantic.FiniteFloat, ...]


class ScoringParameters(Parameters):
    """Parameters of all network rules."""

    candidates: int = pydantic.Field(CANDIDATES, ge=1, le=1000)
    """Maximum number of candidates that the network scores. If there are more, only the best by the
    ranking of the learning environment are scored."""


class Layer(Model):
    """A layer of a network; each output is a constant plus a weighted sum of the layer's inputs."""

    weights: tuple[Row, ...]
    """A row for each input, with a weight for each output."""
    biases: Row
    """The constant term of each output."""

    @pydantic.model_validator(mode="after")
    def _check(self) -> Layer:
        if not self.biases or not self.weights:
            raise ValueError("a layer needs at least one input and one output")
        for number, row in enumerate(self.weights):
            if len(row) != len(self.biases):
                raise ValueError(
                    f"weights[{number}] has {len(row)} numbers, biases {len(self.biases)}; each "
                    "row of weights needs as many as there are biases"
                )
        return self


class Network(Model):
    """Scores a candidate by a weighted sum of its features, plus the output of the layers."""

    linear: dict[str, pydantic.FiniteFloat] = pydantic.Field(default_factory=dict)
    """Weights of the scaled features of a candidate; of those not named, 0."""
    decline: dict[str, pydantic.FiniteFloat] | None = None
    """Score of declining, that is, of choosing no candidate: a `constant` plus weights of scaled
    features of the warehouse. Without it, a candidate is always chosen if there is one."""
    inputs: tuple[str, ...] = ()
    """Inputs of the first layer: features of a candidate and, with the prefix `all.`, of the
    warehouse."""
    layers: tuple[Layer, ...] = ()
    """Layers; negative outputs of all but the last one are replaced by 0. The last layer has one
    output, which is added to the weighted sum."""

    @pydantic.model_validator(mode="after")
    def _check(self) -> Network:
        if bool(self.layers) != bool(self.inputs):
            raise ValueError("inputs and layers must both be given, or neither")
        if not self.layers:
            return self
        if len(self.layers[0].weights) != len(self.inputs):
            raise ValueError(
                f"layers[0].weights has {len(self.layers[0].weights)} rows; one for each of the "
                f"{len(self.inputs)} inputs is needed"
            )
        for number, (one, other) in enumerate(pairwise(self.layers), 1):
            if len(other.weights) != len(one.biases):
                raise ValueError(
                    f"layers[{number}].weights has {len(other.weights)} rows; one for each of the "
                    f"{len(one.biases)} outputs of the layer before it is needed"
                )
        if len(self.layers[-1].biases) != 1:
            raise ValueError(f"the last layer has {len(self.layers[-1].biases)} outputs, not 1")
        return self


def start(kind: str) -> Network:
    """Return the untrained network for a kind of question; it has no layers."""
    weights, constant = STARTS[kind]
    return Network(linear=weights, decline=None if constant is None else {CONSTANT: constant})


def checked(kind: str, network: Network) -> Network:
    """Return a network unchanged if it suits a kind of question.

    Raises
    ------
    ValueError
        If a feature is unknown or named twice in `inputs`, or if the network has a score for
        declining although declining is impossible for this kind of question.
    """
    own = COLUMNS[kind]
    _refuse_unknown("linear", network.linear, own)
    _refuse_unknown("decline", network.decline or (), (CONSTANT, *WHOLE))
    _refuse_unknown("inputs", network.inputs, (*own, *(PREFIX + name for name in WHOLE)))
    if len(set(network.inputs)) < len(network.inputs):
        raise ValueError("inputs: each feature may be named only once")
    if kind == "next station" and network.decline is not None:
        raise ValueError("decline: must be absent, because a station must be chosen")
    return network


def _refuse_unknown(
    key: str, names: Sequence[str] | dict[str, float], valid: Sequence[str]
) -> None:
    for name in names:
        if name not in valid:
            raise ValueError(f"{key}: {name} is unknown; valid: {', '.join(valid)}")


class Scorer:
    """Evaluates a network for one kind of question.

    Parameters
    ----------
    kind
        Kind of question, a key of `rmfs.control.features.COLUMNS`.
    candidates
        Maximum number of candidates that are scored; if there are more, only the best by
        `rmfs.control.features.RANKINGS` are scored.
    """

    def __init__(self, kind: str, network: Network, candidates: int = CANDIDATES) -> None:
        self.kind = kind
        names = COLUMNS[kind]
        scales = np.array([SCALES[name] for name in names], np.float64)
        columns = np.arange(len(names))
        self._offered = weights_of(kind), candidates, scales, columns, len(names), LIMIT
        self._linear = [network.linear.get(name, 0.0) for name in names]
        declining = network.decline
        self._declining = None if declining is None else dict(declining)
        self._layers = [(np.array(one.weights), np.array(one.biases)) for one in network.layers]
        places = {name: place for place, name in enumerate(names)}
        wholes = {PREFIX + name: place for place, name in enumerate(WHOLE)}
        inputs = list(enumerate(network.inputs))
        self._own = [(row, places[name]) for row, name in inputs if name in places]
        self._whole = [(row, wholes[name]) for row, name in inputs if name in wholes]

    def best_of(
        self, candidates: Candidates, view: View, among: NDArray[np.intp] | None = None
    ) -> int:
        """Return the row with the highest score; -1 to decline, or if there is no candidate.

        Ties between candidates go to the one that is ranked higher; a tie between a candidate and
        declining goes to the candidate.

        Parameters
        ----------
        among
            Rows to choose from. Default: all.
        """
        count = len(candidates) if among is None else len(among)
        if not count:
            return -1
        block = unscaled(candidates, self.kind, view)
        if among is not None:
            block = block[:, among]
        best, features = offered(block, *self._offered)
        whole = overview(view)
        scores = self.scores(features[: len(best)], whole)
        chosen = int(scores.argmax())
        declining = self.declining(whole)
        if declining is not None and declining > scores[chosen]:
            return -1
        row = best[chosen] if among is None else among[best[chosen]]
        return int(row)

    def scores(
        self, features: NDArray[np.float32], whole: NDArray[np.float32]
    ) -> NDArray[np.float64]:
        """Return the scores of C candidates, shape (C,).

        Parameters
        ----------
        features
            The F scaled features of each candidate, in order of `COLUMNS`, shape (C, F).
        whole
            The G scaled features of the warehouse, in order of `GLOBAL_FEATURES`, shape (G,).
        """
        given = features.astype(np.float64)
        found = np.zeros(len(given))
        for place, weight in enumerate(self._linear):
            found += weight * given[:, place]
        if not self._layers:
            return found
        weights, biases = self._layers[0]
        same = biases.copy()
        for row, place in self._whole:
            same += float(whole[place]) * weights[row]
        values = np.tile(same, (len(given), 1))
        for row, place in self._own:
            values += given[:, place, np.newaxis] * weights[row]
        for weights, biases in self._layers[1:]:
            hidden = np.maximum(values, 0.0)
            values = np.tile(biases, (len(given), 1))
            for place, row_weights in enumerate(weights):
                values += hidden[:, place, np.newaxis] * row_weights
        found += values[:, 0]
        return found

    def declining(self, whole: NDArray[np.float32]) -> float | None:
        """Return the score of declining; None if the network always chooses a candidate."""
        if self._declining is None:
            return None
        score = self._declining.get(CONSTANT, 0.0)
        for place, name in enumerate(WHOLE):
            score += self._declining.get(name, 0.0) * float(whole[place])
        return score
