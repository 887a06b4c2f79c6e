"""Shortest path over single steps: open one order, or fetch another pod.

Independent of the visit-by-visit reasoning of the models: whatever happens while a pod stands at
the station happens here one order at a time.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from rmfs.solvers.models.sequencing import Sequencing


def fewest_visits(data: Sequencing) -> float:
    """The least number of visits; inf if there is no plan."""
    needs = [frozenset(np.flatnonzero(row).tolist()) for row in data.needs]
    holds = [frozenset(np.flatnonzero(row).tolist()) for row in data.holds]
    # The missing SKUs of open orders, the orders not yet opened, and the pod at the station.
    opened = frozenset((o, needs[o]) for o in range(data.orders) if data.open[o])
    closed = frozenset(o for o in range(data.orders) if not data.open[o])
    root = (opened, closed, -1)
    seen = {root: 0}
    queue = deque([root])
    while queue:
        state = queue.popleft()
        at, waiting, pod = state
        if not at and not waiting:
            return seen[state]
        steps = []
        if len(at) < data.capacity and pod >= 0:
            for order in waiting:
                left = needs[order] - holds[pod]
                steps.append(
                    (0, (at | ({(order, left)} if left else set()), waiting - {order}, pod))
                )
        for other in range(data.pods):
            served = frozenset((o, missing - holds[other]) for o, missing in at)
            steps.append((1, (frozenset(s for s in served if s[1]), waiting, other)))
        for cost, after in steps:
            if seen.get(after, np.inf) > seen[state] + cost:
                seen[after] = seen[state] + cost
                (queue.append if cost else queue.appendleft)(after)
    return np.inf


def tiny(seed: int) -> Sequencing:
    """A random input of up to 5 orders, 5 SKUs and 4 pods; sometimes infeasible."""
    rng = np.random.default_rng(seed)
    orders, skus, pods = int(rng.integers(0, 6)), int(rng.integers(1, 6)), int(rng.integers(1, 5))
    needs = rng.random((orders, skus)) < 0.45
    needs[~needs.any(axis=1), 0] = True
    capacity = int(rng.integers(1, 4))
    opened = np.zeros(orders, dtype=bool)
    opened[: min(orders, int(rng.integers(0, capacity + 1)))] = rng.random() < 0.4
    return Sequencing(needs, rng.random((pods, skus)) < 0.5, capacity, opened)
