"""What a whole run can reach: a proven bound, and a diagnostic at the measured pile-on.

The two are never mixed: `units_per_h_bound` holds for every controller and every run,
`units_per_h_at_pile_on` describes one run and may be passed by another.
"""

from solvers.models.run_bound.data import Orders as Orders
from solvers.models.run_bound.data import PickStations as PickStations
from solvers.models.run_bound.data import Refill as Refill
from solvers.models.run_bound.data import RunBound as RunBound
from solvers.models.run_bound.data import Stock as Stock
from solvers.models.run_bound.data import Throughput as Throughput
from solvers.models.run_bound.data import objective as objective
from solvers.models.run_bound.legs import Legs as Legs
from solvers.models.run_bound.legs import visit_legs as visit_legs
from solvers.models.run_bound.linear import solve as solve
from solvers.models.run_bound.linear import units_per_h_bound as units_per_h_bound
from solvers.models.run_bound.linear import violations as violations
from solvers.models.run_bound.pile_on import units_per_h_at_pile_on as units_per_h_at_pile_on
from solvers.models.run_bound.single import single_bounds as single_bounds
