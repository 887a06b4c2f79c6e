"""Square regions of the floor, and sums of a quantity along trips through the regions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Index = NDArray[np.integer] | np.integer

REGION_M = 6.0
"""Side of a region, in m."""


class Regions:
    """Square regions of the floor, on all tiers.

    Attributes
    ----------
    shape
        Numbers of tiers, rows (along y) and columns (along x).
    of
        Region of each waypoint, as an index into a flattened array of shape `shape`; shape (N,).
    """

    def __init__(self, layout: Layout) -> None:
        self.x = (layout.x_m - layout.x_m.min()) / REGION_M
        self.y = (layout.y_m - layout.y_m.min()) / REGION_M
        self.column, self.row = self.x.astype(np.intp), self.y.astype(np.intp)
        self.tier = layout.tier.astype(np.intp)
        self.shape = (
            int(self.tier.max()) + 1,
            int(self.row.max()) + 1,
            int(self.column.max()) + 1,
        )
        self.of: NDArray[np.intp] = np.ravel_multi_index(
            (self.tier, self.row, self.column), self.shape
        )

    def sums(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return, for each region, the sum of the values of its waypoints, shape `shape`.

        Parameters
        ----------
        values
            Value of each waypoint, shape (N,).
        """
        cells = int(np.prod(self.shape))
        sums: NDArray[np.float64] = np.bincount(self.of, values, cells).astype(np.float64)
        return sums.reshape(self.shape)


class Density:
    """Adds up, along trips, a quantity that is given per metre driven in each region.

    Parameters
    ----------
    regions
        The regions of the floor.
    per_metre
        The quantity per metre driven in each region, shape `regions.shape`.
    """

    def __init__(self, regions: Regions, per_metre: NDArray[np.float64]) -> None:
        tiers, rows, columns = regions.shape
        self._regions = regions
        self._crossed = per_metre * REGION_M
        self._by_x = np.zeros((tiers, rows, columns + 1))
        self._by_y = np.zeros((tiers, rows + 1, columns))
        self._crossed.cumsum(axis=2, out=self._by_x[:, :, 1:])
        self._crossed.cumsum(axis=1, out=self._by_y[:, 1:, :])

    def along(self, waypoint: int, others: NDArray[np.integer]) -> NDArray[np.float64]:
        """Return the sums of the quantity along trips from a waypoint to n others, shape (n,).

        A trip goes straight along one axis and then straight along the other; the result is the
        mean over the two possible sequences. Waypoints on other tiers are treated as if they were
        on the tier of `waypoint`.
        """
        regions = self._regions
        tier, row, column = (of[waypoint] for of in (regions.tier, regions.row, regions.column))
        rows, columns = regions.row[others], regions.column[others]
        x_first = np.abs(self._to_x(tier, row, others) - self._to_x(tier, row, waypoint))
        x_first += np.abs(self._to_y(tier, columns, others) - self._to_y(tier, columns, waypoint))
        y_first = np.abs(self._to_y(tier, column, others) - self._to_y(tier, column, waypoint))
        y_first += np.abs(self._to_x(tier, rows, others) - self._to_x(tier, rows, waypoint))
        total: NDArray[np.float64] = 0.5 * (x_first + y_first)
        return total

    def _to_x(self, tier: np.intp, row: Index, at: Index | int) -> NDArray[np.float64]:
        """Return the sum in a row from its beginning to the x of waypoints."""
        column = self._regions.column[at]
        return self._upto(self._by_x, (tier, row, column), self._regions.x[at] - column)

    def _to_y(self, tier: np.intp, column: Index, at: Index | int) -> NDArray[np.float64]:
        """Return the sum in a column from its beginning to the y of waypoints."""
        row = self._regions.row[at]
        return self._upto(self._by_y, (tier, row, column), self._regions.y[at] - row)

    def _upto(
        self, before: NDArray[np.float64], region: tuple[Index, ...], part: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return the sum over the regions before the given one and over a part of the given one."""
        upto: NDArray[np.float64] = before[region] + part * self._crossed[region]
        return upto
