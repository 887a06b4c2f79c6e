"""Random stations for tests, benchmarks and first experiments."""

from __future__ import annotations

import numpy as np

from rmfs.solvers.models.sequencing.data import Sequencing


def station(orders: int, pods: int, skus: int, capacity: int, seed: int) -> Sequencing:
    """Draw a feasible input.

    Parameters
    ----------
    orders, pods, skus
        How many of each; a pod at least, and a SKU.
    capacity
        Most orders open at a time.
    seed
        Seed of the draw.

    Returns
    -------
    Orders of 1 to 4 SKUs; pods with a sixth of the SKUs, popular ones more often; every SKU on one
    pod at least.
    """
    rng = np.random.default_rng(seed)
    weight = rng.exponential(1.0, skus) + 0.05
    weight /= weight.sum()
    needs = np.zeros((orders, skus), dtype=np.bool_)
    for order in range(orders):
        count = min(1 + rng.binomial(3, 0.4), skus)
        needs[order, rng.choice(skus, count, replace=False, p=weight)] = True
    holds = np.zeros((pods, skus), dtype=np.bool_)
    for pod in range(pods):
        count = max(1, skus // 6)
        holds[pod, rng.choice(skus, count, replace=False, p=weight)] = True
    holds[np.arange(skus) % pods, np.arange(skus)] |= ~holds.any(axis=0)
    return Sequencing(needs, holds, capacity)
