"""Assign at most one task to each robot, and at most one robot to each task, by travel time."""

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.tasks.matching import assignment, flow, greedy
from rmfs.solvers.models.tasks.matching.data import Matching as Matching
from rmfs.solvers.models.tasks.matching.data import objective as objective
from rmfs.solvers.models.tasks.matching.data import violations as violations

solve = Methods[Matching, NDArray[np.int64]](
    {"assignment": assignment.solve, "flow": flow.solve, "greedy": greedy.solve},
    default="assignment",
    rule="greedy",
)
methods = solve.names
