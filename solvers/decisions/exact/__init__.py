"""Questions as mixed-integer programmes that any solver takes, and its solutions as answers.

- `formulation`: the exact programme of each family; `pairs` and `routes` are those that the models
  have no matrix of, because they solve these families in other ways;
- `writing`: MPS and LP files; `reading`: solution files of solvers;
- `external`: solvers as commands.
"""

from rmfs.solvers.decisions.exact.formulation import Exact as Exact
from rmfs.solvers.decisions.exact.formulation import exact as exact
