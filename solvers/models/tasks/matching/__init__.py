"""Robots to tasks, at most one each, by travel time."""

from rmfs.solvers.models.tasks.matching.assignment import solve as solve
from rmfs.solvers.models.tasks.matching.data import Matching as Matching
from rmfs.solvers.models.tasks.matching.data import objective as objective
from rmfs.solvers.models.tasks.matching.data import violations as violations
from rmfs.solvers.models.tasks.matching.greedy import solve as solve_greedily

__all__ = ["Matching", "objective", "solve", "solve_greedily", "violations"]
