"""Multi-station rack allocation: assign orders and as few pods as possible to pick stations."""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.rack_allocation import cp_sat, greedy, highs
from rmfs.solvers.models.rack_allocation.data import Allocation as Allocation
from rmfs.solvers.models.rack_allocation.data import RackAllocation as RackAllocation
from rmfs.solvers.models.rack_allocation.data import objective as objective
from rmfs.solvers.models.rack_allocation.data import violations as violations

solve = Methods[RackAllocation, Allocation](
    {"cp_sat": cp_sat.solve, "highs": highs.solve, "greedy": greedy.solve},
    default="cp_sat",
    rule="greedy",
)
methods = solve.names
