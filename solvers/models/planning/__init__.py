"""Planning ahead: which pods visit which station in which sequence, and what each serves.

- `greedy`: the start rule; `lns`: large neighbourhood search from its plan;
- `cp_sat`: exact, for a few visits and about twenty orders.
"""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.planning import cp_sat, greedy, highs, lns
from rmfs.solvers.models.planning.data import Planning as Planning
from rmfs.solvers.models.planning.values import Plan as Plan
from rmfs.solvers.models.planning.values import nothing as nothing
from rmfs.solvers.models.planning.values import objective as objective
from rmfs.solvers.models.planning.values import violations as violations

solve = Methods[Planning, Plan](
    {"cp_sat": cp_sat.solve, "highs": highs.solve, "greedy": greedy.solve, "lns": lns.solve},
    default="lns",
    rule="greedy",
)
methods = solve.names
