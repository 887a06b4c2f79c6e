"""POA network: assigns the pair of order and station that a network scores highest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pydantic

from rmfs.control.candidates import candidates_for
from rmfs.control.network import Network, Scorer, ScoringParameters, checked, start
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.problems import Problem
from rmfs.control.questions import Question

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.decisions import AssignOrder
    from rmfs.control.view import View


class NetworkParameters(ScoringParameters):
    """Parameters of POA network."""

    network: Network = pydantic.Field(default_factory=lambda: start("poa"))
    """The network that scores pairs of order and station (see the page on learning)."""

    @pydantic.field_validator("network")
    @classmethod
    def _check(cls, network: Network) -> Network:
        return checked("poa", network)


class NetworkRule(PickOrderAssignment[NetworkParameters]):
    """Assigns the pair of order and station with the highest score, then the next.

    All stations with a free slot are paired with all orders of the backlog. There is no fast lane.
    The rule stops when declining has a higher score than every pair.
    """

    parameters_model = NetworkParameters

    def __init__(self, parameters: NetworkParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._scorer = Scorer("poa", parameters.network, parameters.candidates)

    def decide(self) -> Iterator[AssignOrder]:
        """Yield assignments until declining is better."""
        while True:
            found = candidates_for(self.view, Question(Problem.POA, "turn"))
            row = self._scorer.best_of(found, self.view)
            if row < 0:
                return
            yield found[row]
