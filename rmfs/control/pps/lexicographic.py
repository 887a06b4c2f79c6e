"""PPS lexicographic: one scorer after the other, each among what the former left equal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from rmfs.control.pps import LateBinding, PodSelection
from rmfs.control.pps.candidates import Candidates, pick_candidates, replenishment_candidates
from rmfs.control.pps.scorers import (
    BundleScorer,
    BundleWorkAmount,
    Completeable,
    Nearest,
    PickScorer,
    PickWorkAmount,
    RandomScorer,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation


class Scorer(Protocol):
    """Rates candidates; the highest score wins."""

    def score(self, candidates: Any, rng: np.random.Generator) -> np.ndarray[Any, Any]:
        """Scores of all candidates, shape (C,)."""
        ...


class LexicographicParameters(LateBinding):
    """Parameters of PPS lexicographic."""

    pick_pod: tuple[PickScorer, ...] = (Completeable(), PickWorkAmount(), Nearest())
    """Scorers of pods for a pick station, the first counting most."""
    replenishment_pod: tuple[BundleScorer, ...] = (
        BundleWorkAmount(),
        Nearest(metric="distance"),
        RandomScorer(),
    )
    """Scorers of pods for a replenishment station."""


class Lexicographic(PodSelection[LexicographicParameters]):
    """Takes the pod that is best by the first scorer, then by the second, and so on.

    Full ties: the pod with the lowest number. A pod that has been served goes to the station where
    it finds most work; ties: the nearest, then the one with the lowest number.
    """

    parameters_model = LexicographicParameters

    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Choose by the scorers for pick stations."""
        return self._best(pick_candidates(self.view, robot, station), self.parameters.pick_pod)

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose by the scorers for replenishment stations."""
        candidates = replenishment_candidates(self.view, robot, station)
        return self._best(candidates, self.parameters.replenishment_pod)

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose by amount of work, then by distance."""
        view = self.view
        work = [view.work_for(robot.pod, station) for station in stations]
        best = [s for s, amount in zip(stations, work, strict=True) if amount == max(work)]
        waypoints = np.array([view.stations[station].waypoint for station in best])
        return best[int(view.travel.metres(robot.waypoint, waypoints).argmin())]

    def _best(self, candidates: Candidates, scorers: Sequence[Scorer]) -> int:
        if not len(candidates):
            return -1
        for scorer in scorers:
            if len(candidates) == 1:
                break
            scores = scorer.score(candidates, self.rng)
            tied = (scores == scores.max()).nonzero()[0]
            if len(tied) < len(candidates):
                candidates = candidates.narrowed(tied)
        return int(candidates.pods[0])
