"""One adapter per solver, which takes a `LinearProgram` and `Limits` and returns an `Outcome`.

The adapters of integer programs share one signature, so any of them can solve a model. All are
deterministic: they use one thread, a fixed seed and limits in counted work. Running out of
wall-clock time can only raise an error, never change a result.

`assignment` and `flow` solve linear assignment and minimum-cost flow. Both problems are polynomial,
so they are solved to the end without a limit. Optimality is proven by dual potentials that are
computed here and do not rely on the solver.
"""

from rmfs.solvers.models.backends.outcome import Outcome as Outcome
