"""Random inputs for tests, benchmarks and first experiments."""

from __future__ import annotations

import numpy as np

from rmfs.solvers.models.planning.data import Planning


def planning(
    *,
    stations: int = 2,
    slots: int = 3,
    orders: int = 8,
    pods: int = 6,
    skus: int = 5,
    visits: int = 2,
    seed: int = 0,
) -> Planning:
    """Draw an input.

    Parameters
    ----------
    stations, slots, orders, pods, skus, visits
        How many of each; slots and visits per station. There are more pods than stations.
    seed
        Seed of the draw.

    Returns
    -------
    Orders of one to three lines of one or two units, some of them open; one pod under way to the
    first station; pods with about two SKUs.
    """
    rng = np.random.default_rng(seed)
    stock = rng.integers(1, 5, (pods, skus)) * (rng.random((pods, skus)) < 2.0 / skus)
    order_station = np.full(orders, -1)
    is_open = rng.random(orders) < 0.2
    order_station[is_open] = rng.integers(0, stations, int(is_open.sum()))
    line_order, line_sku = [], []
    for order in range(orders):
        lines = min(1 + int(rng.integers(3)), skus)
        line_sku += rng.choice(skus, lines, replace=False).tolist()
        line_order += [order] * lines
    for station in range(stations):
        here = np.flatnonzero(order_station == station)
        order_station[here[slots:]] = -1
    cost = rng.integers(5, 30, (pods, stations)).astype(np.float64)
    cost[0] = np.inf
    until = np.where((order_station == 0) & (rng.random(orders) < 0.5), 0, -1)
    units = rng.integers(1, 3, len(line_order))
    return Planning(
        slots=np.full(stations, slots),
        coming=np.array([0]),
        coming_to=np.array([0]),
        order_station=order_station,
        order_until=until,
        order_worth=rng.integers(0, 8, orders).astype(np.float64),
        line_order=np.array(line_order),
        line_sku=np.array(line_sku),
        line_units=units,
        line_worth=(10.0 * units).astype(np.float64),
        stock=stock,
        cost=cost,
        visits=visits,
        decay=0.9,
    )
