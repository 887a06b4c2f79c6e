"""Rack sequencing: serve the orders of one station with the fewest pod visits.

The problem is that of Boysen, Briskorn, Emde 2017. The methods are:

- `dynamic`: exact, for at most about ten orders;
- `cp_sat`: exact unless a limit ends the search;
- `beam`: beam search followed by local search, for any size.
"""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.sequencing import beam, cp_sat, dynamic
from rmfs.solvers.models.sequencing.data import Sequencing as Sequencing
from rmfs.solvers.models.sequencing.data import VisitSequence as VisitSequence
from rmfs.solvers.models.sequencing.data import finish as finish
from rmfs.solvers.models.sequencing.data import objective as objective
from rmfs.solvers.models.sequencing.data import violations as violations

solve = Methods[Sequencing, VisitSequence](
    {"cp_sat": cp_sat.solve, "dynamic": dynamic.solve, "beam": beam.solve},
    default="cp_sat",
    rule="beam",
)
methods = solve.names
