"""A proven upper bound on the number of units that a warehouse can pick in a given time."""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.run_bound import highs
from rmfs.solvers.models.run_bound.data import Orders as Orders
from rmfs.solvers.models.run_bound.data import PickStations as PickStations
from rmfs.solvers.models.run_bound.data import Refill as Refill
from rmfs.solvers.models.run_bound.data import RunBound as RunBound
from rmfs.solvers.models.run_bound.data import Stock as Stock
from rmfs.solvers.models.run_bound.data import Throughput as Throughput
from rmfs.solvers.models.run_bound.data import objective as objective
from rmfs.solvers.models.run_bound.legs import Legs as Legs
from rmfs.solvers.models.run_bound.legs import visit_legs as visit_legs
from rmfs.solvers.models.run_bound.program import violations as violations
from rmfs.solvers.models.run_bound.single import single_bounds as single_bounds

solve = Methods[RunBound, Throughput]({"highs": highs.solve}, default="highs")
methods = solve.names
