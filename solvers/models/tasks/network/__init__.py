"""Linear assignment and minimum-cost flow, with proofs of optimality that trust no solver.

Both are polynomial: they run to their end, so that no limit is needed and their work is a function
of the size alone. What the solvers return is checked by potentials computed here (linear
programming duality): the bounds hold whatever a solver did.
"""

from solvers.models.tasks.network.assignment import Assigned as Assigned
from solvers.models.tasks.network.assignment import assign as assign
from solvers.models.tasks.network.assignment import assignment_bound as assignment_bound
from solvers.models.tasks.network.assignment import greedy_assign as greedy_assign
from solvers.models.tasks.network.costs import costs as costs
from solvers.models.tasks.network.flow import Flow as Flow
from solvers.models.tasks.network.flow import Network as Network
from solvers.models.tasks.network.flow import flow_bound as flow_bound
from solvers.models.tasks.network.flow import min_cost_flow as min_cost_flow
