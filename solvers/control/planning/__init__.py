"""TA planning: plans several future visits of pods to each station, and the orders they serve."""

from rmfs.solvers.control.planning.controller import PlanningControl as PlanningControl
