"""Questions as mixed-integer programs for any solver, and solutions of solvers as answers.

- `formulation` states the exact program of each family; `pairs` and `routes` contain the programs
  of those families for which the models themselves have no mixed-integer program.
- `writing` writes MPS and LP files; `reading` reads solution files of solvers.
- `external` runs other solvers as commands.
"""

from rmfs.solvers.decisions.exact.formulation import Exact as Exact
from rmfs.solvers.decisions.exact.formulation import exact as exact
