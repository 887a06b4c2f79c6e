"""Questions as mixed-integer programs for any solver, and solutions of solvers as answers.

- `formulation`: the exact program of each family; `pairs` and `routes` contain the programs of
  families that the models solve without a matrix;
- `writing`: MPS and LP files; `reading`: solution files of solvers;
- `external`: runs other solvers as commands.
"""

from rmfs.solvers.decisions.exact.formulation import Exact as Exact
from rmfs.solvers.decisions.exact.formulation import exact as exact
