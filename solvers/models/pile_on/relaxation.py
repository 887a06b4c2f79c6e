"""Lower bounds on the pile-on models from the linear relaxation (cvxpy, Clarabel).

The relaxation of the candidates' program gives row multipliers; `safe_bound` makes a bound of them.
If candidates were pruned, the same multipliers are *priced* over the full program: any multipliers
bound it, and columns that pruning left out can only lower the bound, by as much as they would have
been worth. So a pruned decision gets an honest bound at the price of a pruned LP.
"""

from __future__ import annotations

import numpy as np

from solvers.models.backends.clarabel import LinearRelaxation, Relaxation, relax
from solvers.models.backends.safe_bound import safe_bound
from solvers.models.pile_on.candidates import Candidates, everything
from solvers.models.pile_on.data import PileOn
from solvers.models.pile_on.program import formulate
from solvers.models.solution import NO_LIMITS, Limits

__all__ = ["LinearRelaxation", "bound"]
