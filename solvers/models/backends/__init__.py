"""One adapter per solver: a `LinearProgram` and `Limits` in, an `Outcome` out.

The adapters share one signature, so that a model is solved by any of them. Each is deterministic:
one thread, a fixed seed, limits in counted work. The wall clock can only raise an error.
"""

from solvers.models.backends.outcome import Outcome as Outcome
