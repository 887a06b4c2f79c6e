"""Plans by enumeration: every sequence of pods, every visit of every line."""

from __future__ import annotations

from itertools import permutations, product
from typing import TYPE_CHECKING

import numpy as np

from rmfs.solvers.models.planning import Plan, objective, violations

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.solvers.models.planning import Planning


def best(data: Planning) -> float:
    """Return the least objective of all feasible plans."""
    return min(objective(data, plan) for plan in plans(data) if not violations(data, plan))


def plans(data: Planning) -> Iterator[Plan]:
    """Yield every plan that could be feasible."""
    counts = range(data.visits + 1)
    sequences = [pods for count in counts for pods in permutations(range(data.pods), count)]
    for pods in product(sequences, repeat=data.stations):
        if len(set(sum(pods, ()))) < sum(map(len, pods)):
            continue
        longest = max(len(a) + len(b) for a, b in zip(data.under_way, pods, strict=True))
        for visits in product(range(-1, longest), repeat=data.lines):
            for station in _stations(data, np.array(visits, np.int64)):
                yield Plan(pods, station, np.array(visits, np.int64))


def _stations(data: Planning, visits: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the stations that orders can have if their lines have these visits."""
    served = np.zeros(data.orders, bool)
    served[data.line_order[visits >= 0]] = True
    free = np.flatnonzero(served & (data.order_station < 0))
    for chosen in product(range(data.stations), repeat=len(free)):
        station = data.order_station.copy()
        station[free] = chosen
        yield station
