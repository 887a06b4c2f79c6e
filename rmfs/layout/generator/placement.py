"""Where pods and robots stand at the start of a run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from rmfs.random import Stream, generator

if TYPE_CHECKING:
    from numpy.typing import NDArray

PODS, ROBOTS = 0, 1


def draw_pods(places: NDArray[np.int32], share: float, seed: int, tier: int) -> NDArray[np.int32]:
    """Choose at random the storage locations where a tier's pods stand at the start of a run.

    The locations are drawn from `places`, uniformly and without replacement. The number drawn is
    `share` times the number of places, rounded down.
    """
    count = math.floor(share * len(places) + 1e-9)
    return _draw(places, count, seed, PODS, tier)


def draw_robots(tiles: NDArray[np.int32], count: int, seed: int, tier: int) -> NDArray[np.int32]:
    """Choose at random the waypoints where a tier's robots stand at the start of a run.

    `count` waypoints are drawn from the road waypoints `tiles`, uniformly and without replacement.
    With the same seed, a greater `count` only adds waypoints to those drawn for a smaller one.
    """
    return _draw(tiles, count, seed, ROBOTS, tier)


def _draw(
    candidates: NDArray[np.int32], count: int, seed: int, what: int, tier: int
) -> NDArray[np.int32]:
    rng = generator(seed, Stream.LAYOUT, what, tier)
    return rng.permutation(candidates)[:count].astype(np.int32)
