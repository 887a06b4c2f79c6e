"""POA linear: assigns the pair of order and station with the greatest weighted sum of features."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pydantic

from rmfs.control.candidates import candidates_for
from rmfs.control.linear import Weights, best_of, checked, default_weights
from rmfs.control.poa.filling import FastLaneParameters, Filling
from rmfs.control.problems import Problem
from rmfs.control.questions import Question

if TYPE_CHECKING:
    from rmfs.control.decisions import AssignOrder
    from rmfs.world.stations import PickStation


class LinearParameters(FastLaneParameters):
    """Parameters of POA linear."""

    fast_lane: bool = True
    """Whether orders that the pod at the head of a station's queue can complete are assigned to the
    station before other orders (fast lane). Stations with several slots reserve one of them for
    such orders."""
    weights: Weights = pydantic.Field(default_factory=lambda: default_weights("poa"))
    """Weights of the scaled features of a pair of order and station (see the page on learning)."""

    @pydantic.field_validator("weights")
    @classmethod
    def _check(cls, weights: Weights) -> Weights:
        return checked("poa", weights)


class Linear(Filling[LinearParameters]):
    """Repeatedly assigns the pair of station and order with the greatest weighted sum of features.

    All stations with a free slot are paired with all orders that stock can serve. Unless
    `fast_lane` is false, orders for the fast lane come first. Ties go to the order that arrived
    first, then to the station with the lowest number.
    """

    parameters_model = LinearParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the pair of an order and a station with the greatest weighted sum of features."""
        found = candidates_for(self.view, Question(Problem.POA, "turn"))
        numbers = [station.index for station in stations]
        served = (found.columns["in_stock"] > 0) & np.isin(found.columns["station"], numbers)
        row = best_of(found, "poa", self.view, self.parameters.weights, np.flatnonzero(served))
        return found[row] if row >= 0 else None
