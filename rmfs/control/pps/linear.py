"""PPS linear: chooses the pod, or station, with the greatest weighted sum of features."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pydantic

from rmfs.control.candidates import candidates_for
from rmfs.control.linear import Weights, best_of, checked, default_weights
from rmfs.control.pps import LateBinding, PodSelection
from rmfs.control.problems import Problem
from rmfs.control.questions import Question

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation

_KINDS = {
    "pick_pod": "pick pod",
    "replenishment_pod": "replenishment pod",
    "next_station": "next station",
}


class LinearParameters(LateBinding):
    """Parameters of PPS linear."""

    pick_pod: Weights = pydantic.Field(default_factory=lambda: default_weights("pick pod"))
    """Weights of the scaled features of candidate pods for a pick station (see the page on
    learning)."""
    replenishment_pod: Weights = pydantic.Field(
        default_factory=lambda: default_weights("replenishment pod")
    )
    """Weights of the scaled features of candidate pods for a replenishment station."""
    next_station: Weights = pydantic.Field(default_factory=lambda: default_weights("next station"))
    """Weights of the scaled features of candidate stations for a pod that has been served."""

    @pydantic.field_validator(*_KINDS)
    @classmethod
    def _check(cls, weights: Weights, info: pydantic.ValidationInfo) -> Weights:
        return checked(_KINDS[str(info.field_name)], weights)


class Linear(PodSelection[LinearParameters]):
    """Chooses the pod, or the next station, with the greatest weighted sum of features.

    Ties go to the pod or station with the lowest number. Regardless of the parameter `consider`,
    pods are chosen for orders assigned to the station, and for orders of its pool that a single pod
    can complete.
    """

    parameters_model = LinearParameters

    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Choose a pod for a pick station."""
        question = Question(Problem.PPS, "pick pod", robot.index, (station.index,))
        return self._best(question, self.parameters.pick_pod)

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose a pod for a replenishment station."""
        question = Question(Problem.PPS, "replenishment pod", robot.index, (station.index,))
        return self._best(question, self.parameters.replenishment_pod)

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose the next station of a carried pod."""
        question = Question(Problem.PPS, "next station", robot.index, tuple(stations))
        return self._best(question, self.parameters.next_station)

    def _best(self, question: Question, weights: Weights) -> int:
        found = candidates_for(self.view, question)
        row = best_of(found, question.kind, self.view, weights)
        answer: Any = found[row] if row >= 0 else -1
        return int(answer)
