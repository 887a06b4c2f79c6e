"""Assign each stay of a pod in storage to a zone of places, if the next visits are known."""

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.storage.stays import cp_sat, flow, greedy, highs
from rmfs.solvers.models.storage.stays.data import Stays as Stays
from rmfs.solvers.models.storage.stays.data import objective as objective
from rmfs.solvers.models.storage.stays.data import violations as violations
from rmfs.solvers.models.storage.stays.places import places as places

solve = Methods[Stays, NDArray[np.int64]](
    {"cp_sat": cp_sat.solve, "highs": highs.solve, "flow": flow.solve, "greedy": greedy.solve},
    default="cp_sat",
    rule="greedy",
)
methods = solve.names
