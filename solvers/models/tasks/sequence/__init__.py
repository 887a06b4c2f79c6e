"""Several tasks in a row per robot: the return of one pod combined with the fetch of the next."""

from rmfs.solvers.models.tasks.sequence.bound import relaxed_bound as relaxed_bound
from rmfs.solvers.models.tasks.sequence.candidates import Ways as Ways
from rmfs.solvers.models.tasks.sequence.candidates import every_way as every_way
from rmfs.solvers.models.tasks.sequence.candidates import short_ways as short_ways
from rmfs.solvers.models.tasks.sequence.cp_sat import solve as solve
from rmfs.solvers.models.tasks.sequence.data import Routes as Routes
from rmfs.solvers.models.tasks.sequence.data import Sequence as Sequence
from rmfs.solvers.models.tasks.sequence.insertion import solve as solve_greedily
from rmfs.solvers.models.tasks.sequence.schedule import arrivals_s as arrivals_s
from rmfs.solvers.models.tasks.sequence.schedule import objective as objective
from rmfs.solvers.models.tasks.sequence.schedule import violations as violations

__all__ = [
    "Routes",
    "Sequence",
    "Ways",
    "arrivals_s",
    "every_way",
    "objective",
    "relaxed_bound",
    "short_ways",
    "solve",
    "solve_greedily",
    "violations",
]
