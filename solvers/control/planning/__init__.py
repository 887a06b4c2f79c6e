"""TA planning: plans several visits of pods per station ahead, with orders and robots."""

from rmfs.solvers.control.planning.controller import PlanningControl as PlanningControl
