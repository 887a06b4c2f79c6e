"""Random snapshots like those of a site, for tests, benchmarks and first experiments."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmfs.solvers.models.checks import integers
from rmfs.solvers.models.pile_on.data import Floats, Integers, PileOn
from rmfs.solvers.models.pile_on.variant import Variant, Weights


@dataclass(frozen=True)
class Size:
    """How big a snapshot is.

    Parameters
    ----------
    stations, slots
        Pick stations, and free slots at each of them.
    pods, skus
        Pods in the store and SKUs in the range.
    orders
        Open orders in the backlog.
    robots
        Free robots; 0: robots are not decided.
    inbound
        Pods on their way per station, each with an order waiting for it.
    skus_per_pod
        SKUs on a pod, if there are as many. Default 5.
    """

    stations: int
    slots: int
    pods: int
    skus: int
    orders: int
    robots: int = 0
    inbound: int = 1
    skus_per_pod: int = 5

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            integers(f"size.{name}", value, (), low=0)


SMALL = Size(stations=2, slots=3, pods=100, skus=100, orders=100, robots=4, skus_per_pod=3)
"""The small layout of Jiao et al. (2025): 2 stations, 100 pods, 100 SKUs, a backlog of 100."""

MEDIUM = Size(stations=6, slots=2, pods=500, skus=400, orders=120, robots=10)
"""Half a site."""

LARGE = Size(stations=12, slots=2, pods=1200, skus=1000, orders=200, robots=20)
"""A real site in the middle of a day: 12 stations with two free slots each."""

LARGE_EMPTY = Size(stations=12, slots=6, pods=1200, skus=1000, orders=200, robots=45, inbound=0)
"""The same site at the start of a day: every slot of every station free, every robot idle."""


def snapshot(
    size: Size,
    seed: int,
    *,
    variant: Variant = Variant.WHOLE,
    weights: Weights | None = None,
) -> PileOn:
    """Draw a snapshot.

    Stations stand along one side of a square store, travel is rectilinear in metres. SKU
    popularity is exponential (rate 0.5 after scaling), orders have 1 to 4 lines of 1 to 3 units,
    mostly one; a pod holds 1 to 12 units of each of its SKUs.

    Parameters
    ----------
    size
        How big.
    seed
        Seed of the draw.
    variant, weights
        Passed on. Defaults: whole orders, M1G weights.

    Returns
    -------
    The snapshot; the same for the same arguments.
    """
    rng = np.random.default_rng(seed)
    side = np.sqrt(size.pods) * 2.0
    place = rng.uniform(0.0, side, (size.pods, 2))
    gate = np.stack([np.linspace(0.0, side, size.stations), np.full(size.stations, -5.0)], axis=1)
    weight = rng.exponential(0.5, size.skus) if size.skus else np.zeros(0)
    stock = np.zeros((size.pods, size.skus), dtype=np.int64)
    for pod in range(size.pods):
        held = _distinct(rng, weight, size.skus_per_pod)
        stock[pod, held] = rng.integers(1, 13, held.size)
    line_order, line_sku = _lines(rng, size, weight)
    inbound = np.full(size.pods, -1)
    count = min(size.inbound * size.stations, size.pods)
    inbound[rng.permutation(size.pods)[:count]] = np.arange(count) % max(size.stations, 1)
    open_units = np.zeros((size.stations, size.skus), dtype=np.int64)
    for pod in np.flatnonzero(inbound >= 0).tolist():
        wanted = rng.choice(np.flatnonzero(stock[pod]))
        open_units[inbound[pod], wanted] += rng.integers(1, 3)
    fetch = None
    if size.robots:
        robot = rng.uniform(0.0, side, (size.robots, 2))
        fetch = _distance(robot, place)
    return PileOn(
        slots=np.full(size.stations, size.slots),
        line_order=line_order,
        line_sku=line_sku,
        line_units=1 + rng.binomial(2, 0.2, line_sku.size),
        stock=stock,
        travel=_distance(place, gate),
        available=inbound < 0,
        inbound=inbound,
        open_units=open_units,
        fetch=fetch,
        variant=variant,
        weights=Weights() if weights is None else weights,
    )


def _distinct(rng: np.random.Generator, weight: Floats, most: int) -> Integers:
    """Up to `most` different SKUs, drawn by weight."""
    count = min(most, weight.size)
    if not count:
        return np.zeros(0, dtype=np.int64)
    return np.sort(rng.choice(weight.size, count, replace=False, p=weight / weight.sum()))


def _lines(rng: np.random.Generator, size: Size, weight: Floats) -> tuple[Integers, Integers]:
    """Order and SKU of every line, sorted."""
    count = 1 + rng.binomial(3, 0.25, size.orders)
    skus = [_distinct(rng, weight, int(n)) for n in count]
    order = np.repeat(np.arange(size.orders), [len(s) for s in skus])
    return order, np.concatenate(skus) if skus else np.zeros(0, dtype=np.int64)


def _distance(one: Floats, other: Floats) -> Floats:
    """Rectilinear distance of all pairs, in whole metres."""
    apart: Floats = np.abs(one[:, None, :] - other[None, :, :]).sum(axis=2)
    return np.rint(apart)
