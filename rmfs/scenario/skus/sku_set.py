"""The SKUs of a scenario as arrays."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.scenario.categorical import Categorical

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.scenario.skus.affinity import Affinity


@dataclass(frozen=True)
class SkuSet:
    """K SKUs, identified by their index 0 ... K - 1.

    Attributes
    ----------
    ids
        Id number of each SKU in the file of SKUs, shape (K,); its index if it has no such number.
    popularity
        Relative weight with which each SKU is ordered and replenished, shape (K,), rounded to 30
        significant bits.
    space_per_unit
        Space units that one unit of each SKU takes, shape (K,); multiples of 2**-20 (see
        `exact.space`).
    bundle_units
        Units per bundle of each SKU, shape (K,).
    affinity
        Weights of pairs of SKUs, for drawing lines by affinity; None if every line is drawn by
        popularity.
    names
        Names of the SKUs, which are not part of the digest; empty if the SKUs have no names.
    """

    ids: NDArray[np.int64]
    popularity: NDArray[np.float64]
    space_per_unit: NDArray[np.float64]
    bundle_units: NDArray[np.int64]
    affinity: Affinity | None = None
    names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for array in (self.ids, self.popularity, self.space_per_unit, self.bundle_units):
            if array.shape != self.ids.shape:
                raise ValueError("all arrays of a SKU set must have the same length")
            array.setflags(write=False)
        if self.names and len(self.names) != len(self.ids):
            raise ValueError("either all SKUs of a set must have a name, or none")

    def __len__(self) -> int:
        return len(self.ids)

    @cached_property
    def bundle_space(self) -> NDArray[np.float64]:
        """Space units that one bundle of each SKU takes, shape (K,)."""
        return self.space_per_unit * self.bundle_units

    @cached_property
    def by_popularity(self) -> Categorical:
        """Sampler of SKUs by popularity; its `probabilities` are the normalised popularities."""
        return Categorical(self.popularity)

    @cached_property
    def index_of(self) -> dict[int, int]:
        """Index of each SKU by its id."""
        return {sku: index for index, sku in enumerate(self.ids.tolist())}

    def digest(self) -> str:
        """Return the SHA-256 of all arrays and of the affinity; it is the same on every machine."""
        hashed = hashlib.sha256()
        for array in (self.ids, self.popularity, self.space_per_unit, self.bundle_units):
            hashed.update(array.astype(array.dtype.newbyteorder("<")).tobytes())
        if self.affinity is not None:
            hashed.update(self.affinity.digest().encode())
        return hashed.hexdigest()

    def check_fit(self, pod_capacity: float, source: str = "skus") -> None:
        """Raise an error if a bundle fits into no pod.

        Parameters
        ----------
        pod_capacity
            Capacity of the largest pod, in space units.
        source
            Name of the scenario, for the message.

        Raises
        ------
        InputError
            If a bundle of some SKU is too large.
        """
        too_large = np.flatnonzero(self.bundle_space > pod_capacity)
        if len(too_large):
            worst = too_large[np.argmax(self.bundle_space[too_large])]
            raise InputError(
                f"{source}: bundles of {len(too_large)} SKUs do not fit into any pod, for example "
                f"{self.bundle_units[worst]} units of SKU {self.ids[worst]} take "
                f"{self.bundle_space[worst]:.6g} space units and a pod holds {pod_capacity:g}"
            )
