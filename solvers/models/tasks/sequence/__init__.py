"""Several tasks in a row per robot: the return of one pod combined with the fetch of the next."""

from solvers.models.tasks.sequence.bound import relaxed_bound as relaxed_bound
from solvers.models.tasks.sequence.candidates import Ways as Ways
from solvers.models.tasks.sequence.candidates import every_way as every_way
from solvers.models.tasks.sequence.candidates import short_ways as short_ways
from solvers.models.tasks.sequence.cp_sat import solve as solve
from solvers.models.tasks.sequence.data import Routes as Routes
from solvers.models.tasks.sequence.data import Sequence as Sequence
from solvers.models.tasks.sequence.insertion import solve as solve_greedily
from solvers.models.tasks.sequence.schedule import arrivals_s as arrivals_s
from solvers.models.tasks.sequence.schedule import objective as objective
from solvers.models.tasks.sequence.schedule import violations as violations

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
