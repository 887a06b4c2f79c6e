"""Robots to tasks with balanced stations and due times."""

from solvers.models.tasks.balance.data import Balance as Balance
from solvers.models.tasks.balance.data import objective as objective
from solvers.models.tasks.balance.data import violations as violations
from solvers.models.tasks.balance.flow import solve as solve
from solvers.models.tasks.balance.greedy import solve as solve_greedily

__all__ = ["Balance", "objective", "solve", "solve_greedily", "violations"]
