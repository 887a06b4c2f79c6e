"""Optimisation models: each takes a frozen dataclass of arrays and returns a `Solution`.

The models do not depend on the simulation, so they can be solved, tested and timed without it.
`rmfs.solvers.control` fills the arrays from the state of a simulation and applies the solutions.
"""

from rmfs.solvers.models.checks import ModelError as ModelError
from rmfs.solvers.models.solution import Limits as Limits
from rmfs.solvers.models.solution import Sense as Sense
from rmfs.solvers.models.solution import Solution as Solution
from rmfs.solvers.models.solution import Status as Status
from rmfs.solvers.models.solution import WallGuardError as WallGuardError
