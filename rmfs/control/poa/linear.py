"""POA linear: the order and station whose features have the greatest weighted sum."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.candidates import candidates_for
from rmfs.control.linear import Weights, best_of, checked, default_weights
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.problems import Problem
from rmfs.control.questions import Question

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.decisions import AssignOrder


class LinearParameters(Parameters):
    """Parameters of POA linear."""

    weights: Weights = pydantic.Field(default_factory=lambda: default_weights("poa"))
    """Of the features of a pair of order and station, scaled (docs: learning)."""

    @pydantic.field_validator("weights")
    @classmethod
    def _check(cls, weights: Weights) -> Weights:
        return checked("poa", weights)


class Linear(PickOrderAssignment[LinearParameters]):
    """Fills free slots, each time with the best pair of a station and an order in stock.

    Full ties: the order that came first, then the station with the lowest number.
    """

    parameters_model = LinearParameters

    def decide(self) -> Iterator[AssignOrder]:
        """Yield the best pair until no slot is free or no order can be served."""
        question, weights = Question(Problem.POA, "turn"), self.parameters.weights
        while True:
            found = candidates_for(self.view, question)
            served = np.flatnonzero(found.columns["in_stock"])
            row = best_of(found, "poa", self.view, weights, served)
            if row < 0:
                return
            yield found[row]
