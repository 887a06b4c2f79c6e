"""Back ends: adapters to solvers of integer programs, relaxations, assignment and flow problems.

`highs` and `cp_sat` solve integer programs. They have the same signature: each takes a
`LinearProgram` and `Limits` and returns an `Outcome`, so either can solve a model whose columns are
all integer. `clarabel` solves linear relaxations. All back ends are deterministic: they use one
thread, a given seed and limits in counted work. Running out of wall-clock time can only raise an
error, never change a result.

`assignment` and `flow` solve linear assignment and minimum-cost flow problems. Both kinds of
problem are solvable in polynomial time, so no limits are needed. Optimality is proven by dual
values that are computed here, independently of the solver.
"""

from rmfs.solvers.models.backends.outcome import Outcome as Outcome
