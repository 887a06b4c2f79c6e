"""Multi-station rack allocation: orders and pods to pick stations with the fewest pods."""

from rmfs.solvers.models.rack_allocation.data import Allocation as Allocation
from rmfs.solvers.models.rack_allocation.data import RackAllocation as RackAllocation
from rmfs.solvers.models.rack_allocation.data import objective as objective
from rmfs.solvers.models.rack_allocation.data import violations as violations
from rmfs.solvers.models.rack_allocation.exact import solve_by_cp_sat as solve_by_cp_sat
from rmfs.solvers.models.rack_allocation.exact import solve_by_highs as solve_by_highs
from rmfs.solvers.models.rack_allocation.greedy import solve as solve_greedily

__all__ = [
    "Allocation",
    "RackAllocation",
    "objective",
    "solve_by_cp_sat",
    "solve_by_highs",
    "solve_greedily",
    "violations",
]
