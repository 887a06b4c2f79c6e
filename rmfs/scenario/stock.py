"""Initial stock of the pods."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.random import Stream, generator
from rmfs.scenario.bundles import bundle_of_each

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from rmfs.scenario.bundles import BundleContent
    from rmfs.scenario.skus import SkuSet

    ChoosePod = Callable[[BundleContent, NDArray[np.float64]], int]
    Place = Callable[[BundleContent, NDArray[np.float64]], int | None]

POD_DRAWS = 32
"""Maximum number of random pods that are tried for a bundle before all pods are searched."""


@dataclass(frozen=True)
class InitialStock:
    """Bundles in the order in which they were put into pods.

    Attributes
    ----------
    pod, sku, units
        Pod, SKU and units of each of the n bundles, shape (n,).
    share
        Space that the bundles take, as a share of the capacity of all pods. It is less than
        requested only if no pod has room for a further bundle.
    """

    pod: NDArray[np.int64]
    sku: NDArray[np.int64]
    units: NDArray[np.int64]
    share: float

    def contents(self, pods: int, skus: int) -> NDArray[np.int64]:
        """Return the units of each SKU on each pod, shape (pods, skus)."""
        units = np.zeros((pods, skus), dtype=np.int64)
        np.add.at(units, (self.pod, self.sku), self.units)
        return units


def initial_stock(
    skus: SkuSet,
    pod_capacity: NDArray[np.float64],
    share: float,
    seed: int,
    choose: ChoosePod | None = None,
    first: Sequence[int] = (),
) -> InitialStock:
    """Fill a share of the pods' capacity with bundles, whose SKUs are drawn by popularity.

    A drawn bundle for which no pod has room left is dropped, and another one is drawn; filling
    ends early if no pod has room for a bundle of any SKU.

    Parameters
    ----------
    pod_capacity
        Capacity of each pod, in space units, shape (P,).
    share
        Share of the pods' total capacity to fill, in [0, 1]; once it is reached, no further bundle
        is drawn.
    seed
        The run's seed.
    choose
        Function that returns the index of a pod with room for a bundle. Its arguments are the
        bundle and the free space of each pod, shape (P,). It is called only if there is such a pod.
        Default: all pods with room are equally likely.
    first
        SKUs of the bundles that are stored before other bundles are drawn, one entry per bundle.

    Raises
    ------
    InputError
        If a bundle of some SKU is larger than the largest pod, or no pod has room for a bundle of
        `first`.
    ValueError
        If `choose` returns a pod without room for a drawn bundle. This is not checked for the
        bundles of `first`.
    """
    skus.check_fit(pod_capacity.max(initial=0.0))
    place = _into_random_pods(seed) if choose is None else _where_possible(choose)
    uniform = _uniform_numbers(seed, 0)
    free = pod_capacity.astype(np.float64)
    capacity = math.fsum(free.tolist())
    bundles = bundle_of_each(skus)
    placed: list[tuple[int, int, int]] = []
    stored = 0.0
    for needed in first:
        pod = place(bundles[needed], free)
        if pod is None:
            raise InputError(
                f"stock.order_cover: only {len(placed)} of the {len(first)} bundles that orders "
                f"need fit into the pods; all bundles take "
                f"{math.fsum(skus.bundle_space[list(first)].tolist()):g} space units, and the pods "
                f"hold {capacity:g}"
            )
        free[pod] -= bundles[needed].space
        stored += bundles[needed].space
        placed.append((pod, needed, bundles[needed].units))
    # free space only shrinks: what did not fit once never will, nor will anything larger
    too_large = math.inf
    while stored < share * capacity:
        sku = _draw_sku(skus, too_large, next(uniform))
        if sku is None:
            break
        bundle = bundles[sku]
        pod = place(bundle, free)
        if pod is None:
            too_large = bundle.space
            continue
        if free[pod] < bundle.space:
            raise ValueError(f"pod {pod} has no room for {bundle}")
        free[pod] -= bundle.space
        stored += bundle.space
        placed.append((pod, sku, bundle.units))
    pods, stored_skus, units = np.array(placed, dtype=np.int64).reshape(-1, 3).T.copy()
    return InitialStock(pods, stored_skus, units, share=stored / capacity if capacity else 0.0)


def _draw_sku(skus: SkuSet, too_large: float, number: float) -> int | None:
    """Draw a SKU whose bundle takes less than `too_large` space units; None if there is none."""
    if too_large == math.inf:
        return skus.by_popularity.pick(number)
    return skus.by_popularity.pick_among(skus.bundle_space < too_large, number)


def _into_random_pods(seed: int) -> Place:
    """Return the rule that draws a pod with room, all equally likely."""
    # a stream of its own, so that the same SKUs are stored whatever rule places them
    uniform = _uniform_numbers(seed, 1)

    def place(bundle: BundleContent, free: NDArray[np.float64]) -> int | None:
        for _ in range(POD_DRAWS):
            pod = int(next(uniform) * len(free))
            if free.item(pod) >= bundle.space:
                return pod
        fitting = np.flatnonzero(free >= bundle.space)
        return int(fitting[int(next(uniform) * len(fitting))]) if len(fitting) else None

    return place


def _where_possible(choose: ChoosePod) -> Place:
    """Return the rule that calls `choose` if any pod has room, and returns None otherwise."""

    def place(bundle: BundleContent, free: NDArray[np.float64]) -> int | None:
        return choose(bundle, free) if free.max() >= bundle.space else None

    return place


def _uniform_numbers(seed: int, part: int) -> Iterator[float]:
    """Yield an endless sequence of uniform numbers from a part of the stream of initial stock."""
    numbers = generator(seed, Stream.INITIAL_STOCK, part)
    while True:
        yield from numbers.random(4096).tolist()
