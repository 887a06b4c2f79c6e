"""Assign classes of pods to zones of places in the steady state; compute prices of places."""

from rmfs.solvers.models.methods import Methods
from rmfs.solvers.models.storage.zones import clarabel, greedy
from rmfs.solvers.models.storage.zones.data import ZonePlan as ZonePlan
from rmfs.solvers.models.storage.zones.data import Zones as Zones
from rmfs.solvers.models.storage.zones.data import objective as objective
from rmfs.solvers.models.storage.zones.data import violations as violations
from rmfs.solvers.models.storage.zones.prices import Prices as Prices
from rmfs.solvers.models.storage.zones.prices import expected_stay_h as expected_stay_h
from rmfs.solvers.models.storage.zones.prices import place_values as place_values
from rmfs.solvers.models.storage.zones.prices import price_bound as price_bound

solve = Methods[Zones, ZonePlan](
    {"clarabel": clarabel.solve, "greedy": greedy.solve}, default="clarabel", rule="greedy"
)
methods = solve.names
