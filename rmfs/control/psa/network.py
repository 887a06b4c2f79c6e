"""PSA network: chooses the storage location with the highest score of a neural network."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pydantic

from rmfs.control.candidates import candidates_for
from rmfs.control.network import Network, Scorer, ScoringParameters, checked, start
from rmfs.control.problems import Problem
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.questions import Question

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class NetworkParameters(ScoringParameters):
    """Parameters of PSA network."""

    network: Network = pydantic.Field(default_factory=lambda: start("place"))
    """The network that scores storage locations (see the page on learning)."""

    @pydantic.field_validator("network")
    @classmethod
    def _check(cls, network: Network) -> Network:
        return checked("place", network)


class NetworkRule(PodStorageAssignment[NetworkParameters]):
    """Chooses the empty storage location to which a neural network gives the highest score.

    The network can also score declining, that is, choosing no location. If declining has the
    highest score, the robot keeps its pod until TA decides again.
    """

    parameters_model = NetworkParameters

    def __init__(self, parameters: NetworkParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._scorer = Scorer("place", parameters.network, parameters.candidates)

    def place(self, robot: Robot) -> int:
        """Choose the location with the highest score; -1 if none is empty or declining wins."""
        found = candidates_for(self.view, Question(Problem.PSA, "place", robot.index))
        row = self._scorer.best_of(found, self.view)
        return int(found[row]) if row >= 0 else -1
