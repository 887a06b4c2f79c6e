"""Ranking of pods and places: the higher a pod's score, the more prominent its place.

Places are storage locations. The shorter the travel time from a place to the nearest pick station,
the more prominent the place (`rmfs.control.trackers.prominence`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.trackers.pod_scores import PodScores
from rmfs.control.trackers.prominence import Prominence

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View

Weight = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class ScoreWeights(Parameters):
    """Weights of utility and speed in the score of a pod (`rmfs.control.trackers.pod_scores`)."""

    utility_weight: Weight = 1.0
    """Weight of utility in a pod's score. Utility is the number of the pod's units that orders
    need, divided by the maximum over all pods."""
    speed_weight: Weight = 1.0
    """Weight of speed in a pod's score. Speed is the number of the pod's units, each weighted by
    how often its SKU is ordered, divided by the maximum over all pods."""

    @pydantic.model_validator(mode="after")
    def _something_counts(self) -> ScoreWeights:
        if not self.utility_weight + self.speed_weight:
            raise ValueError("utility_weight and speed_weight must not both be 0")
        return self


class RankParameters(ScoreWeights):
    """Parameters of rules that rank pods and places."""

    place_buffer: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.05
    """With P pods and L storage locations, the target ranks of the pods are spread evenly over the
    P + `place_buffer` x L most prominent locations."""
    corridor: Annotated[int, pydantic.Field(ge=1)] = 3
    """Minimum number of ranks in which empty storage locations are sought, in this order: the
    target rank, the next better rank, the next worse rank, and so on."""


class Ranking:
    """Ranks pods by score, and finds places of the corresponding rank.

    The P pods are sorted by score, the highest first (ties by number), and the places by
    prominence, the most prominent first. Positions in both orders are counted from 0. The target
    place of the pod at position r is the place at position floor(r x (P + b) / P), where b is
    `place_buffer` times the number of places, rounded down. If there is no such position, the
    target place is the last place. The rank of the target place is the pod's target rank; places of
    equal prominence share a rank.
    """

    def __init__(self, view: View, parameters: RankParameters) -> None:
        self._view = view
        self._parameters = parameters
        self._scores = view.trackers.get(PodScores)
        self.prominence = view.trackers.get(Prominence)
        pods, places = len(view.inventory.capacity), len(view.storage.places)
        spread = pods + int(parameters.place_buffer * places + 1e-9)
        number = np.minimum(np.arange(pods) * spread // pods, places - 1)
        in_order = self.prominence.in_order
        self._target_of_rank = self.prominence.rank[in_order[number]]

    def scores(self) -> NDArray[np.float64]:
        """Return each pod's weighted mean of utility and speed, from 0 to 1, shape (P,)."""
        given = self._parameters
        return self._scores.scores(given.utility_weight, given.speed_weight)

    def target(self, pod: int) -> int:
        """Return the target rank of a pod."""
        scores = self.scores()
        own = scores[pod]
        better = np.count_nonzero(scores > own) + np.count_nonzero(scores[:pod] == own)
        return int(self._target_of_rank[better])

    def targets(self) -> NDArray[np.intp]:
        """Return the target ranks of all pods, shape (P,)."""
        targets = np.empty_like(self._target_of_rank)
        targets[np.argsort(-self.scores(), kind="stable")] = self._target_of_rank
        return targets

    def seen(self, target: int) -> NDArray[np.bool_]:
        """Return whether each of the L places is found empty by a search, shape (L,).

        The search begins with the rank `target` and goes outward: the next better rank, the next
        worse, and so on. It ends when at least `corridor` ranks have been searched and an empty
        place has been found. Ranks that do not exist, beyond the best or the worst, count as
        searched.
        """
        away = self.prominence.rank - target
        look = 2 * np.abs(away) - (away < 0)
        empty = self._view.storage.is_empty
        last = max(self._parameters.corridor - 1, int(look[empty].min(initial=look.max())))
        found: NDArray[np.bool_] = empty & (look <= last)
        return found
