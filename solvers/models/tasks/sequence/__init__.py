"""Task sequences of robots: the storing of one pod is combined with the fetching of the next."""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.tasks.sequence import columns, cp_sat, greedy, lns
from rmfs.solvers.models.tasks.sequence.bound import relaxed_bound as relaxed_bound
from rmfs.solvers.models.tasks.sequence.candidates import Ways as Ways
from rmfs.solvers.models.tasks.sequence.candidates import every_way as every_way
from rmfs.solvers.models.tasks.sequence.candidates import short_ways as short_ways
from rmfs.solvers.models.tasks.sequence.data import Routes as Routes
from rmfs.solvers.models.tasks.sequence.data import TaskSequence as TaskSequence
from rmfs.solvers.models.tasks.sequence.lns import STEPS_PER_TASK as STEPS_PER_TASK
from rmfs.solvers.models.tasks.sequence.schedule import arrivals_s as arrivals_s
from rmfs.solvers.models.tasks.sequence.schedule import objective as objective
from rmfs.solvers.models.tasks.sequence.schedule import violations as violations

solve = Methods[TaskSequence, Routes](
    {
        "cp_sat": cp_sat.solve,
        "columns": columns.solve,
        "lns": lns.solve,
        "greedy": greedy.solve,
    },
    default="cp_sat",
    rule="greedy",
)
methods = solve.names
