"""What no run can exceed: a proven bound on the units that a warehouse picks in a time."""

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
from solvers.models.run_bound.single import single_bounds as single_bounds
