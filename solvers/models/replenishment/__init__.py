"""Replenishment (RPS and ROA): bundles to pods, and these pods to stations.

Both decisions are one: a pod is brought to one station for all its bundles, and the bundles' worth
must pay for its trip.
"""

from rmfs.solvers.models.replenishment.candidates import best_pods as best_pods
from rmfs.solvers.models.replenishment.data import Replenishment as Replenishment
from rmfs.solvers.models.replenishment.data import Stocking as Stocking
from rmfs.solvers.models.replenishment.data import objective as objective
from rmfs.solvers.models.replenishment.data import violations as violations
from rmfs.solvers.models.replenishment.exact import solve_by_cp_sat as solve_by_cp_sat
from rmfs.solvers.models.replenishment.exact import solve_by_highs as solve_by_highs
from rmfs.solvers.models.replenishment.greedy import solve as solve_greedily
from rmfs.solvers.models.replenishment.rounding import solve as solve_by_rounding
from rmfs.solvers.models.replenishment.worth import bundle_worth_s as bundle_worth_s

__all__ = [
    "Replenishment",
    "Stocking",
    "best_pods",
    "bundle_worth_s",
    "objective",
    "solve_by_cp_sat",
    "solve_by_highs",
    "solve_by_rounding",
    "solve_greedily",
    "violations",
]
