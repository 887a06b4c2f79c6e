"""Pods whose next visits are known: which zone of places each stays in, and when."""

from rmfs.solvers.models.storage.stays.data import Stays as Stays
from rmfs.solvers.models.storage.stays.data import objective as objective
from rmfs.solvers.models.storage.stays.data import violations as violations
from rmfs.solvers.models.storage.stays.exact import solve_by_cp_sat as solve_by_cp_sat
from rmfs.solvers.models.storage.stays.exact import solve_by_highs as solve_by_highs
from rmfs.solvers.models.storage.stays.greedy import solve as solve_greedily
from rmfs.solvers.models.storage.stays.places import places as places
from rmfs.solvers.models.storage.stays.two_zones import solve as solve_by_flow

__all__ = [
    "Stays",
    "objective",
    "places",
    "solve_by_cp_sat",
    "solve_by_flow",
    "solve_by_highs",
    "solve_greedily",
    "violations",
]
