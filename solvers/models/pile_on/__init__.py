"""Pile-on: orders to station slots (POA) and pods to stations (PPS), with robots also TA.

- `joint.solve`: the decision for a real site, under a deterministic limit; what controllers call;
- `cp_sat.solve`, `highs.solve`: exact, with M1G (Jiao et al. 2025) as the default weights;
- `greedy.solve`, `hadgs.solve`: rules, which also start the exact solvers;
- `neighbourhood.solve`: two stations at a time, exactly;
- `relaxation`: lower bounds; `candidates`: pruning; `attribution`: which pod gives which units.

All take a `PileOn` and give a `Solution[Assignment]`.
"""

from rmfs.solvers.models.pile_on.attribution import Picks as Picks
from rmfs.solvers.models.pile_on.attribution import attribute as attribute
from rmfs.solvers.models.pile_on.candidates import Candidates as Candidates
from rmfs.solvers.models.pile_on.candidates import Pruning as Pruning
from rmfs.solvers.models.pile_on.candidates import everything as everything
from rmfs.solvers.models.pile_on.candidates import prune as prune
from rmfs.solvers.models.pile_on.data import PileOn as PileOn
from rmfs.solvers.models.pile_on.values import Assignment as Assignment
from rmfs.solvers.models.pile_on.values import objective as objective
from rmfs.solvers.models.pile_on.values import violations as violations
from rmfs.solvers.models.pile_on.variant import Variant as Variant
from rmfs.solvers.models.pile_on.variant import Weights as Weights
