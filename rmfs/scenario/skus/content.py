"""Contents of SKU files, which may be incomplete."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from rmfs.scenario.skus.affinity import Affinity


@dataclass(frozen=True)
class SkuFileContent:
    """K SKUs in the order of the file; None for missing columns.

    Attributes
    ----------
    ids
        Number of each SKU, shape (K,).
    popularity
        Relative weight with which each is ordered, shape (K,).
    space_per_unit
        Space units, shape (K,).
    bundle_units
        Units per bundle, shape (K,).
    affinity
        Weights of pairs; None if the file lists no pairs and the share of affinity is 0.
    names
        Names of the SKUs, or empty.
    """

    ids: NDArray[np.int64]
    popularity: NDArray[np.float64]
    space_per_unit: NDArray[np.float64] | None = None
    bundle_units: NDArray[np.int64] | None = None
    affinity: Affinity | None = None
    names: tuple[str, ...] = ()
