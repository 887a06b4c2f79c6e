"""Pile-on: assign orders and pods to stations (POA, PPS) and, optionally, robots to pods (TA).

The methods are

- `joint`: heuristic and search for sites of realistic size, the default method of controllers;
- `cp_sat`, `highs`: exact methods;
- `greedy`, `hadgs`: heuristics, whose decisions can be the start of the exact methods;
- `neighbourhood`: search that re-optimises two stations at a time exactly.

The default weights are those of the model M1G (Jiao et al. 2025). `relaxation` and `prices` compute
lower bounds. `candidates` selects the pairs (such as pod and station) that a method considers.
"""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.pile_on import cp_sat, greedy, hadgs, highs, joint, neighbourhood
from rmfs.solvers.models.pile_on.candidates import Candidates as Candidates
from rmfs.solvers.models.pile_on.candidates import Pruning as Pruning
from rmfs.solvers.models.pile_on.candidates import everything as everything
from rmfs.solvers.models.pile_on.candidates import prune as prune
from rmfs.solvers.models.pile_on.data import PileOn as PileOn
from rmfs.solvers.models.pile_on.prices import bounded as bounded
from rmfs.solvers.models.pile_on.values import Assignment as Assignment
from rmfs.solvers.models.pile_on.values import objective as objective
from rmfs.solvers.models.pile_on.values import violations as violations
from rmfs.solvers.models.pile_on.variant import Variant as Variant
from rmfs.solvers.models.pile_on.variant import Weights as Weights

solve = Methods[PileOn, Assignment](
    {
        "joint": joint.solve,
        "cp_sat": cp_sat.solve,
        "highs": highs.solve,
        "neighbourhood": neighbourhood.solve,
        "greedy": greedy.solve,
        "hadgs": hadgs.solve,
    },
    default="joint",
    rule="greedy",
)
methods = solve.names
