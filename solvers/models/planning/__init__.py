"""Planning several visits ahead: the sequence of pods at each station, and the lines they serve.

- `greedy`: the start rule;
- `lns`: large neighbourhood search, starting from the plan of `greedy`;
- `cp_sat`: exact, for a few visits and about twenty orders;
- `highs`: exact; an input with 24 visits and 50 lines takes seconds.
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
