"""Assign returning pods to free places at the least cost, including the cost of expected visits."""

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.storage.placement import assignment, flow, greedy
from rmfs.solvers.models.storage.placement.data import Placement as Placement
from rmfs.solvers.models.storage.placement.data import objective as objective
from rmfs.solvers.models.storage.placement.data import violations as violations
from rmfs.solvers.models.storage.placement.visits import expected_visits as expected_visits

solve = Methods[Placement, NDArray[np.int64]](
    {"assignment": assignment.solve, "flow": flow.solve, "greedy": greedy.solve},
    default="assignment",
    rule="greedy",
)
methods = solve.names
