"""Rack sequencing at one station (Boysen, Briskorn, Emde 2017): fewest pod visits.

- `dynamic.solve`: exact, for about ten orders; `cp_sat.solve`: exact, limited by counted work;
- `beam.solve`: beam search with local search, for any size.

All take a `Sequencing` and give a `Solution[Plan]`.
"""

from rmfs.solvers.models.sequencing.data import Plan as Plan
from rmfs.solvers.models.sequencing.data import Sequencing as Sequencing
from rmfs.solvers.models.sequencing.data import finish as finish
from rmfs.solvers.models.sequencing.data import objective as objective
from rmfs.solvers.models.sequencing.data import violations as violations
