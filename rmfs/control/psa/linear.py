"""PSA linear: chooses the storage location with the greatest weighted sum of features."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.candidates import candidates_for
from rmfs.control.linear import Weights, best_of, checked, default_weights
from rmfs.control.problems import Problem
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.questions import Question

if TYPE_CHECKING:
    from rmfs.world.robots import Robot


class LinearParameters(Parameters):
    """Parameters of PSA linear."""

    weights: Weights = pydantic.Field(default_factory=lambda: default_weights("place"))
    """Weights of the scaled features of storage locations (see the page on learning), by name;
    features that are not named have the weight 0."""

    @pydantic.field_validator("weights")
    @classmethod
    def _check(cls, weights: Weights) -> Weights:
        return checked("place", weights)


class Linear(PodStorageAssignment[LinearParameters]):
    """Chooses the empty storage location with the greatest weighted sum of features.

    The features describe a location (`rmfs.control.features`); they include travel times. Ties go
    to the waypoint with the lowest number.
    """

    parameters_model = LinearParameters

    def place(self, robot: Robot) -> int:
        """Choose the storage location with the greatest weighted sum; -1 if none is empty."""
        found = candidates_for(self.view, Question(Problem.PSA, "place", robot.index))
        row = best_of(found, "place", self.view, self.parameters.weights)
        return int(found[row]) if row >= 0 else -1
