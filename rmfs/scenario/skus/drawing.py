"""SKUs drawn from distributions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from rmfs.random import Stream, generator
from rmfs.scenario import exact
from rmfs.scenario.skus.affinity import Affinity
from rmfs.scenario.skus.sku_set import SkuSet

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.scenario.counts import Counts
    from rmfs.scenario.distributions import Space
    from rmfs.scenario.parameters import GeneratedAffinity, GeneratedSkus

# parts of the stream of SKUs
_POPULARITY, _SPACE, _BUNDLE_UNITS, _PAIRS, _POINTS = range(5)


def draw_sku_set(config: GeneratedSkus, seed: int) -> SkuSet:
    """Draw SKUs, with separate random streams for popularity, space, bundle sizes and affinity.

    Parameters
    ----------
    seed
        Seed of the SKUs (`config.seed` in a scenario), not of the run.
    """
    affinity = config.affinity
    uniform = generator(seed, Stream.SKUS, _POPULARITY).random(config.count)
    return SkuSet(
        ids=np.arange(config.count, dtype=np.int64),
        popularity=exact.significant(config.popularity.quantile(uniform)),
        space_per_unit=draw_space(config.space_per_unit, seed, config.count),
        bundle_units=draw_bundle_units(config.bundle_units, seed, config.count),
        affinity=None if affinity is None else draw_affinity(affinity, seed, config.count),
    )


def draw_space(distribution: Space, seed: int, count: int) -> NDArray[np.float64]:
    """Draw the space units that one unit of each SKU takes, shape (count,)."""
    return exact.space(distribution.quantile(generator(seed, Stream.SKUS, _SPACE).random(count)))


def draw_bundle_units(distribution: Counts, seed: int, count: int) -> NDArray[np.int64]:
    """Draw the number of units in a bundle of each SKU, shape (count,)."""
    draw = distribution.sampler()
    uniform = generator(seed, Stream.SKUS, _BUNDLE_UNITS).random(count)
    return np.array([draw(u) for u in uniform.tolist()], dtype=np.int64)


def draw_affinity(config: GeneratedAffinity, seed: int, count: int) -> Affinity:
    """Draw pairs of SKUs; the weight of a pair applies in both directions.

    Each SKU is a random point in the unit square, and the weight of a pair is sqrt(2) minus the
    distance between its points. Because two points near a third one are near each other, two SKUs
    that are often ordered with the same third SKU tend to be ordered together.

    Parameters
    ----------
    config
        Parameters of the affinity; its `pairs` must be at most count (count - 1) / 2.
    seed
        Seed of the SKUs, not of the run.
    count
        Number of SKUs.
    """
    first, second = _draw_pairs(config.pairs, seed, count)
    points = generator(seed, Stream.SKUS, _POINTS).random((count, 2))
    across, along = (points[first] - points[second]).T
    weight = exact.significant(math.sqrt(2) - np.sqrt(across * across + along * along))
    return Affinity(
        first=np.concatenate([first, second]),
        second=np.concatenate([second, first]),
        weight=np.concatenate([weight, weight]),
        default_weight=config.default_weight,
        share=config.share,
    )


def _draw_pairs(wanted: int, seed: int, count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Draw pairs of different SKUs without repetition, the lower index first."""
    if wanted == count * (count - 1) // 2:
        first, second = np.triu_indices(count, 1)
        return first.astype(np.int64), second.astype(np.int64)
    numbers = generator(seed, Stream.SKUS, _PAIRS)
    codes = np.zeros(0, dtype=np.int64)
    while len(codes) < wanted:
        ends = numbers.random((wanted, 2))
        one = (ends[:, 0] * count).astype(np.int64)
        other = (ends[:, 1] * (count - 1)).astype(np.int64)
        other += other >= one
        drawn = np.concatenate([codes, np.minimum(one, other) * count + np.maximum(one, other)])
        _, at = np.unique(drawn, return_index=True)
        codes = drawn[np.sort(at)]
    return np.divmod(codes[:wanted], count)
