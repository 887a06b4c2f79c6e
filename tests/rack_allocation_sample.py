"""Random sites for tests, benchmarks and first experiments."""

from __future__ import annotations

import numpy as np

from rmfs.solvers.models.rack_allocation.data import RackAllocation


def site(orders: int, pods: int, skus: int, stations: int, slots: int, seed: int) -> RackAllocation:
    """Draw orders, pods and stations.

    Parameters
    ----------
    orders, pods, skus, stations
        How many of each.
    slots
        Orders per station.
    seed
        Seed of the draw.

    Returns
    -------
    Orders of 1 to 4 SKUs, mostly one unit each; pods of 5 SKUs, 1 to 12 units each; popular SKUs,
    by an exponential distribution, are ordered and stocked more often.
    """
    rng = np.random.default_rng(seed)
    weight = rng.exponential(1.0, skus) + 0.05
    weight /= weight.sum()
    units = np.zeros((orders, skus), np.int64)
    for order in range(orders):
        chosen = rng.choice(skus, min(1 + rng.binomial(3, 0.3), skus), replace=False, p=weight)
        units[order, chosen] = 1 + rng.binomial(2, 0.1, len(chosen))
    stock = np.zeros((pods, skus), np.int64)
    for pod in range(pods):
        chosen = rng.choice(skus, min(5, skus), replace=False, p=weight)
        stock[pod, chosen] = rng.integers(1, 13, len(chosen))
    return RackAllocation(units, stock, np.full(stations, slots))
