"""Replenishment (RPS and ROA): assign bundles to pods, and these pods to stations.

The two decisions are taken together: all bundles of a pod share one trip to one station, and this
trip pays only if the bundles are worth more than it costs.
"""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.replenishment import cp_sat, greedy, highs, rounding
from rmfs.solvers.models.replenishment.candidates import best_pods as best_pods
from rmfs.solvers.models.replenishment.data import Replenishment as Replenishment
from rmfs.solvers.models.replenishment.data import Stocking as Stocking
from rmfs.solvers.models.replenishment.data import objective as objective
from rmfs.solvers.models.replenishment.data import violations as violations
from rmfs.solvers.models.replenishment.worth import bundle_worth_s as bundle_worth_s

solve = Methods[Replenishment, Stocking](
    {
        "highs": highs.solve,
        "cp_sat": cp_sat.solve,
        "rounding": rounding.solve,
        "greedy": greedy.solve,
    },
    default="highs",
    rule="greedy",
)
methods = solve.names
