"""Robots to tasks with balanced stations and due times."""

from rmfs.solvers.models.tasks.balance.data import Balance as Balance
from rmfs.solvers.models.tasks.balance.data import objective as objective
from rmfs.solvers.models.tasks.balance.data import violations as violations
from rmfs.solvers.models.tasks.balance.flow import solve as solve
from rmfs.solvers.models.tasks.balance.greedy import solve as solve_greedily

__all__ = ["Balance", "objective", "solve", "solve_greedily", "violations"]
