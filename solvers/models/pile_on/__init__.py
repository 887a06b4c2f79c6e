"""Pile-on: orders to station slots (POA) and pods to stations (PPS), with robots also TA.

- `joint.solve`: the decision for a real site, under a deterministic limit; what controllers call;
- `cp_sat.solve`, `highs.solve`: exact, with M1G (Jiao et al. 2025) as the default weights;
- `greedy.solve`, `hadgs.solve`: rules, which also start the exact solvers;
- `neighbourhood.solve`: two stations at a time, exactly;
- `relaxation`: lower bounds; `candidates`: pruning; `attribution`: which pod gives which units.

All take a `PileOn` and give a `Solution[Assignment]`.
"""

from solvers.models.pile_on.attribution import Picks as Picks
from solvers.models.pile_on.attribution import attribute as attribute
from solvers.models.pile_on.candidates import Candidates as Candidates
from solvers.models.pile_on.candidates import Pruning as Pruning
from solvers.models.pile_on.candidates import everything as everything
from solvers.models.pile_on.candidates import prune as prune
from solvers.models.pile_on.data import PileOn as PileOn
from solvers.models.pile_on.values import Assignment as Assignment
from solvers.models.pile_on.values import objective as objective
from solvers.models.pile_on.values import violations as violations
from solvers.models.pile_on.variant import Variant as Variant
from solvers.models.pile_on.variant import Weights as Weights
