"""One adapter per solver: a `LinearProgram` and `Limits` in, an `Outcome` out.

The adapters share one signature, so any of them can solve a model. All are deterministic: they use
one thread, a fixed seed and limits in counted work. Running out of wall-clock time can only raise
an error, never change a result.

`assignment` and `flow` solve linear assignment and minimum-cost flow. Both problems are polynomial:
they are solved to the end without a limit, and the work depends on the size alone. Optimality is
proven by dual potentials that are computed here and do not rely on the solver.
"""

from rmfs.solvers.models.backends.outcome import Outcome as Outcome
