"""PPS lexicographic: applies criteria by priority; each breaks the ties that earlier ones left."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Protocol

import numpy as np
import pydantic

from rmfs.control.pps import LateBinding, PodSelection
from rmfs.control.pps.candidates import Candidates, pick_candidates, replenishment_candidates
from rmfs.control.pps.criteria import (
    BundleCriterion,
    BundleWorkAmount,
    Completeable,
    Nearest,
    PickCriterion,
    PickWorkAmount,
    RandomCriterion,
)
from rmfs.control.pps.station_criteria import (
    MostWork,
    NearestNextStation,
    NextStationCriterion,
    RandomNextStation,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.view import View
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation

AtLeastOne = pydantic.Field(min_length=1)


class Criterion(Protocol):
    """Rates candidate pods (`rmfs.control.pps.candidates`); the highest score wins."""

    def score(self, candidates: Any, rng: np.random.Generator) -> np.ndarray[Any, Any]:
        """Return the scores of all candidates, shape (C,)."""
        ...


class LexicographicParameters(LateBinding):
    """Parameters of PPS lexicographic."""

    pick_pod: Annotated[tuple[PickCriterion, ...], AtLeastOne] = (
        Completeable(),
        PickWorkAmount(),
        Nearest(),
    )
    """Criteria, in order of priority, for choosing a pod for a pick station. Available criteria:
    `random`, `nearest`, `work-amount` (with the variants `pile-on`, `age` and `lateness`),
    `completeable`, `demand`, `fill` and `wave`."""
    replenishment_pod: Annotated[tuple[BundleCriterion, ...], AtLeastOne] = (
        BundleWorkAmount(),
        Nearest(metric="euclidean"),
        RandomCriterion(),
    )
    """Criteria, in order of priority, for choosing a pod for a replenishment station. Available
    criteria: `random`, `nearest`, `work-amount` and `demand`."""
    next_station: Annotated[tuple[NextStationCriterion, ...], AtLeastOne] = (
        MostWork(),
        NearestNextStation(),
        RandomNextStation(),
    )
    """Criteria, in order of priority, for choosing the next station of a carried pod, if TA lets
    the pod continue to other stations. Available criteria: `random`, `nearest` and `work-amount`
    (with the variants `pile-on`, `age` and `lateness`)."""


class Lexicographic(PodSelection[LexicographicParameters]):
    """Chooses the best pod by the first criterion; each further criterion breaks remaining ties.

    The next station of a carried pod is chosen in the same way. If all criteria leave a tie, it
    goes to the pod or station with the lowest number. The criteria for pods are described in
    `rmfs.control.pps.criteria`, and those for stations in `rmfs.control.pps.station_criteria`.
    """

    parameters_model = LexicographicParameters

    def __init__(
        self, parameters: LexicographicParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        for criterion in (*parameters.pick_pod, *parameters.replenishment_pod):
            criterion.prepare(view)

    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Choose a pod by the criteria in the parameter `pick_pod`."""
        candidates = pick_candidates(self.view, robot, station, self.parameters.consider)
        return self._best(candidates, self.parameters.pick_pod)

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose a pod by the criteria in the parameter `replenishment_pod`."""
        candidates = replenishment_candidates(self.view, robot, station)
        return self._best(candidates, self.parameters.replenishment_pod)

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose a station by the criteria in the parameter `next_station`."""
        left = list(stations)
        for criterion in self.parameters.next_station:
            if len(left) == 1:
                break
            scores = criterion.score(self.view, robot, left, self.rng)
            left = [left[position] for position in (scores == scores.max()).nonzero()[0].tolist()]
        return left[0]

    def _best(self, candidates: Candidates, criteria: Sequence[Criterion]) -> int:
        if not len(candidates):
            return -1
        for criterion in criteria:
            if len(candidates) == 1:
                break
            scores = criterion.score(candidates, self.rng)
            tied = (scores == scores.max()).nonzero()[0]
            if len(tied) < len(candidates):
                candidates = candidates.narrowed(tied)
        return int(candidates.pods[0])
