"""PPS network: chooses the pod, or station, that a neural network scores highest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pydantic

from rmfs.control.candidates import candidates_for
from rmfs.control.network import Network, Scorer, ScoringParameters, checked, start
from rmfs.control.pps import LateBinding, PodSelection
from rmfs.control.problems import Problem
from rmfs.control.questions import Question

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation

_KINDS = {
    "pick_pod": "pick pod",
    "replenishment_pod": "replenishment pod",
    "next_station": "next station",
}


class NetworkParameters(ScoringParameters, LateBinding):
    """Parameters of PPS network."""

    pick_pod: Network = pydantic.Field(default_factory=lambda: start("pick pod"))
    """Neural network that scores candidate pods for a pick station (see the page on learning)."""
    replenishment_pod: Network = pydantic.Field(default_factory=lambda: start("replenishment pod"))
    """Neural network that scores candidate pods for a replenishment station."""
    next_station: Network = pydantic.Field(default_factory=lambda: start("next station"))
    """Neural network that scores candidate stations for a pod that has been served."""

    @pydantic.field_validator(*_KINDS)
    @classmethod
    def _check(cls, network: Network, info: pydantic.ValidationInfo) -> Network:
        return checked(_KINDS[str(info.field_name)], network)


class NetworkRule(PodSelection[NetworkParameters]):
    """Chooses the pod, or the next station, that a neural network scores highest.

    The networks for pods can also score the option to choose no pod (declining). If this score is
    higher than that of every pod, no pod is chosen. Regardless of the parameter `consider`, pods
    are chosen for orders assigned to the station, and for orders of its pool that a single pod can
    complete.
    """

    parameters_model = NetworkParameters

    def __init__(self, parameters: NetworkParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._scorers = {
            kind: Scorer(kind, getattr(parameters, name), parameters.candidates)
            for name, kind in _KINDS.items()
        }

    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Choose a pod for a pick station."""
        return self._best(Question(Problem.PPS, "pick pod", robot.index, (station.index,)))

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose a pod for a replenishment station."""
        return self._best(Question(Problem.PPS, "replenishment pod", robot.index, (station.index,)))

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose the next station of a carried pod."""
        return self._best(Question(Problem.PPS, "next station", robot.index, tuple(stations)))

    def _best(self, question: Question) -> int:
        found = candidates_for(self.view, question)
        row = self._scorers[question.kind].best_of(found, self.view)
        answer: Any = found[row] if row >= 0 else -1
        return int(answer)
