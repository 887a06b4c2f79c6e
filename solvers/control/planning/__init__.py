"""TA planning: visits of several pods per station planned ahead, orders and robots with them."""

from rmfs.solvers.control.planning.controller import PlanningControl as PlanningControl
