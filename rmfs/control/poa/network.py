"""POA network: assigns the pair of order and station that a neural network scores highest."""

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
    """Neural network that scores pairs of order and station (see the page on learning)."""

    @pydantic.field_validator("network")
    @classmethod
    def _check(cls, network: Network) -> Network:
        return checked("poa", network)


class NetworkRule(PickOrderAssignment[NetworkParameters]):
    """Repeatedly assigns the pair of order and station that a neural network scores highest.

    Every active station with a free slot is paired with every order of the backlog, except orders
    in the pool of another station. The parameter `candidates` limits how many pairs are scored.
    There is no fast lane. The network also scores the option to assign no order (declining). The
    rule stops when this score is higher than that of every pair.
    """

    parameters_model = NetworkParameters

    def __init__(self, parameters: NetworkParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._scorer = Scorer("poa", parameters.network, parameters.candidates)

    def decide(self) -> Iterator[AssignOrder]:
        """Yield assignments until the option to assign no order has the highest score."""
        while True:
            found = candidates_for(self.view, Question(Problem.POA, "turn"))
            row = self._scorer.best_of(found, self.view)
            if row < 0:
                return
            yield found[row]
