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
    """K SKUs in the order of the file.

    Attributes
    ----------
    ids
        Id number of each SKU, shape (K,).
    popularity
        Relative weight with which each SKU is ordered, shape (K,).
    space_per_unit
        Space units that one unit of each SKU takes, shape (K,); None if missing in the file.
    bundle_units
        Units per bundle of each SKU, shape (K,); None if missing in the file.
    affinity
        Weights of pairs of SKUs; None if the file specifies no affinity.
    names
        Names of the SKUs; empty if the SKUs have no names.
    """

    ids: NDArray[np.int64]
    popularity: NDArray[np.float64]
    space_per_unit: NDArray[np.float64] | None = None
    bundle_units: NDArray[np.int64] | None = None
    affinity: Affinity | None = None
    names: tuple[str, ...] = ()
