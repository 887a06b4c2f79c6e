"""Charging (CA): which robot charges where, when and for how long within a planning horizon."""

from rmfs.solvers.models.charging import cp_sat, greedy, highs
from rmfs.solvers.models.charging.data import AWAY as AWAY
from rmfs.solvers.models.charging.data import ChargePlan as ChargePlan
from rmfs.solvers.models.charging.data import Charging as Charging
from rmfs.solvers.models.charging.data import objective as objective
from rmfs.solvers.models.charging.data import violations as violations
from rmfs.solvers.models.methods import Methods

solve = Methods[Charging, ChargePlan](
    {"highs": highs.solve, "cp_sat": cp_sat.solve, "greedy": greedy.solve},
    default="highs",
    rule="greedy",
)
methods = solve.names
