"""The SKUs of a scenario as arrays."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.random import Stream, generator
from rmfs.scenario import exact
from rmfs.scenario.categorical import Categorical
from rmfs.scenario.parameters import GeneratedSkus, SkuFile
from rmfs.scenario.xgenc import read_xgenc

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.scenario.affinity import Affinity
    from rmfs.scenario.counts import Counts
    from rmfs.scenario.distributions import Space


@dataclass(frozen=True)
class SkuSet:
    """K SKUs; each is named by its index 0 ... K - 1.

    Attributes
    ----------
    ids
        Name of each SKU in its file, or its index, shape (K,).
    popularity
        Relative weight with which a SKU is ordered and replenished, shape (K,), 30 significant
        bits.
    space_per_unit
        Space units that one unit takes, shape (K,), in steps of 2**-20 (`exact.space`).
    bundle_units
        Units per bundle, shape (K,).
    affinity
        How SKUs are ordered together, or None: each line is drawn by popularity.
    """

    ids: NDArray[np.int64]
    popularity: NDArray[np.float64]
    space_per_unit: NDArray[np.float64]
    bundle_units: NDArray[np.int64]
    affinity: Affinity | None = None

    def __post_init__(self) -> None:
        for array in (self.ids, self.popularity, self.space_per_unit, self.bundle_units):
            if array.shape != self.ids.shape:
                raise ValueError("all arrays of a SKU set must have the same length")
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.ids)

    @cached_property
    def bundle_space(self) -> NDArray[np.float64]:
        """Space units of one bundle of each SKU, shape (K,)."""
        return self.space_per_unit * self.bundle_units

    @cached_property
    def by_popularity(self) -> Categorical:
        """Sampler of SKUs by popularity; its `probabilities` are the demand shares."""
        return Categorical(self.popularity)

    def digest(self) -> str:
        """SHA-256 over all arrays: equal for equal SKUs on every machine."""
        hashed = hashlib.sha256()
        for array in (self.ids, self.popularity, self.space_per_unit, self.bundle_units):
            hashed.update(array.astype(array.dtype.newbyteorder("<")).tobytes())
        if self.affinity is not None:
            hashed.update(self.affinity.digest().encode())
        return hashed.hexdigest()

    def check_fit(self, pod_capacity: float, source: str = "skus") -> None:
        """Refuse bundles that no pod can hold.

        Parameters
        ----------
        pod_capacity
            Space units of the largest pod.
        source
            Name of the scenario, for the message.

        Raises
        ------
        InputError
            If a bundle of some SKU is larger.
        """
        too_large = np.flatnonzero(self.bundle_space > pod_capacity)
        if len(too_large):
            worst = too_large[np.argmax(self.bundle_space[too_large])]
            raise InputError(
                f"{source}: bundles of {len(too_large)} SKUs do not fit into any pod, for example "
                f"{self.bundle_units[worst]} units of SKU {self.ids[worst]} take "
                f"{self.bundle_space[worst]:.6g} space units and a pod holds {pod_capacity:g}"
            )


def sku_set(config: GeneratedSkus | SkuFile) -> SkuSet:
    """Return the SKUs that a scenario asks for, drawn or read.

    Raises
    ------
    InputError
        If the file is broken.
    """
    if isinstance(config, SkuFile):
        return _from_file(config)
    return draw_sku_set(config, config.seed)


def draw_sku_set(config: GeneratedSkus, seed: int) -> SkuSet:
    """Draw SKUs; popularity, space and bundle sizes have a stream each.

    Parameters
    ----------
    seed
        Seed of the SKUs, not of the run (`config.seed` in a scenario).
    """
    uniform = generator(seed, Stream.SKUS, 0).random(config.count)
    return SkuSet(
        ids=np.arange(config.count, dtype=np.int64),
        popularity=exact.significant(config.popularity.quantile(uniform)),
        space_per_unit=_draw_space(config.space_per_unit, seed, config.count),
        bundle_units=_draw_bundle_units(config.bundle_units, seed, config.count),
    )


def _from_file(config: SkuFile) -> SkuSet:
    read = read_xgenc(config.file)
    count = len(read.ids)
    space = read.space_per_unit
    bundle_units = read.bundle_units
    return SkuSet(
        ids=read.ids,
        popularity=exact.significant(read.popularity),
        space_per_unit=_draw_space(config.space_per_unit, config.seed, count)
        if space is None
        else exact.space(space),
        bundle_units=_draw_bundle_units(config.bundle_units, config.seed, count)
        if bundle_units is None
        else bundle_units,
        affinity=read.affinity,
    )


def _draw_space(distribution: Space, seed: int, count: int) -> NDArray[np.float64]:
    return exact.space(distribution.quantile(generator(seed, Stream.SKUS, 1).random(count)))


def _draw_bundle_units(distribution: Counts, seed: int, count: int) -> NDArray[np.int64]:
    draw = distribution.sampler()
    uniform = generator(seed, Stream.SKUS, 2).random(count)
    return np.array([draw(u) for u in uniform.tolist()], dtype=np.int64)
