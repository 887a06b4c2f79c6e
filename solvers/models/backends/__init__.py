"""One adapter per solver: a `LinearProgram` and `Limits` in, an `Outcome` out.

The adapters share one signature, so that a model is solved by any of them. Each is deterministic:
one thread, a fixed seed, limits in counted work. The wall clock can only raise an error.

`assignment` and `flow` solve linear assignment and minimum-cost flow. Both are polynomial: they run
to their end, so that no limit is needed and their work is a function of the size alone. Their
optimality is proven by potentials computed here (duality), whatever a solver did.
"""

from rmfs.solvers.models.backends.outcome import Outcome as Outcome
