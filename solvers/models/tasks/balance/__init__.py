"""Assign robots to tasks; balance the queues of stations, and consider due times."""

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.tasks.balance import flow, greedy
from rmfs.solvers.models.tasks.balance.data import Balance as Balance
from rmfs.solvers.models.tasks.balance.data import objective as objective
from rmfs.solvers.models.tasks.balance.data import violations as violations

solve = Methods[Balance, NDArray[np.int64]](
    {"flow": flow.solve, "greedy": greedy.solve}, default="flow", rule="greedy"
)
methods = solve.names
