"""Returning pods to free places, with the pods' expected next visits in the cost."""

from rmfs.solvers.models.storage.placement.assignment import solve as solve
from rmfs.solvers.models.storage.placement.data import Placement as Placement
from rmfs.solvers.models.storage.placement.data import objective as objective
from rmfs.solvers.models.storage.placement.data import violations as violations
from rmfs.solvers.models.storage.placement.greedy import solve as solve_greedily
from rmfs.solvers.models.storage.placement.visits import expected_visits as expected_visits

__all__ = [
    "Placement",
    "expected_visits",
    "objective",
    "solve",
    "solve_greedily",
    "violations",
]
