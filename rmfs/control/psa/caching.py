"""Decision on which pods deserve a place in the cache near a pick station."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.psa.ranking import ScoreWeights, Weight
from rmfs.control.trackers.pod_scores import PodScores
from rmfs.control.trackers.zones import ZoneParameters, Zones

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View


class CacheParameters(ScoreWeights, ZoneParameters):
    """Parameters of rules that decide which pods belong in a cache."""

    speed_weight: Weight = 0.0
    """Weight of speed in a pod's score. Speed is the number of the pod's units, each weighted by
    how often its SKU is ordered, divided by the maximum over all pods."""
    fill_weight: Weight = 1.0
    """In the decision whether a pod deserves a place in a cache: weight of the share of the cache
    that is free."""
    value_weight: Weight = 1.0
    """In the decision whether a pod deserves a place in a cache: weight of the share of the pods in
    the cache that have a lower score than this pod."""
    threshold: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.5
    """A pod deserves a place in a cache if the weighted mean of two shares (see `fill_weight` and
    `value_weight`) is above this threshold."""

    @pydantic.model_validator(mode="after")
    def _something_counts_for_caches(self) -> CacheParameters:
        if not self.fill_weight + self.value_weight:
            raise ValueError("fill_weight and value_weight must not both be 0")
        return self


class Caching:
    """Decides which pods deserve a place in a cache.

    Attributes
    ----------
    zones
        The zones of all storage locations.
    cache_at
        For each of the N waypoints, the pick station to whose cache the waypoint belongs, or -1;
        shape (N,).
    """

    def __init__(self, view: View, parameters: CacheParameters) -> None:
        self._view = view
        self._parameters = parameters
        self._scores = view.trackers.get(PodScores)
        self.zones = view.trackers.get(Zones, ZoneParameters.of(parameters))
        self.cache_at = np.full(view.layout.waypoints, -1, np.int64)
        self.cache_at[view.storage.places] = self.zones.cache_of

    def scores(self) -> NDArray[np.float64]:
        """Return each pod's weighted mean of utility and speed, from 0 to 1, shape (P,)."""
        given = self._parameters
        return self._scores.scores(given.utility_weight, given.speed_weight)

    def is_worth(self, pod: int, station: int, scores: NDArray[np.float64]) -> bool:
        """Return whether a pod deserves a place in a station's cache; false if there is no cache.

        Parameters
        ----------
        scores
            Scores of all pods, shape (P,).
        """
        given = self._parameters
        size = int(self.zones.cache_size[station])
        if not size:
            return False
        storage = self._view.storage
        inside = storage.is_stored & (self.cache_at[storage.pod_waypoint] == station)
        inside[pod] = False
        pods = np.count_nonzero(inside)
        lower = np.count_nonzero(scores[inside] < scores[pod])
        value = lower / pods if pods else 1.0
        free = 1 - int(self.zones.occupied()[station]) / size
        weights = given.fill_weight + given.value_weight
        return (given.fill_weight * free + given.value_weight * value) / weights > given.threshold
