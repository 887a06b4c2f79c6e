"""Visits planned ahead: which pods come to which station in which order, and what each serves.

`solve` plans by the start rule, by large neighbourhood search, or exactly by CP-SAT. The input is a
`Planning`, the result a `Solution[Plan]`.
"""

from rmfs.solvers.models.planning.data import Planning as Planning
from rmfs.solvers.models.planning.solve import Method as Method
from rmfs.solvers.models.planning.solve import solve as solve
from rmfs.solvers.models.planning.values import Plan as Plan
from rmfs.solvers.models.planning.values import nothing as nothing
from rmfs.solvers.models.planning.values import objective as objective
from rmfs.solvers.models.planning.values import violations as violations
