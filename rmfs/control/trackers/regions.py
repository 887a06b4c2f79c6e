"""Square regions of the floor, and sums along straight trips through them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

REGION_M = 6.0
"""Side of a region, in m."""


class Regions:
    """Square regions of the floor, on all tiers.

    Attributes
    ----------
    shape
        Numbers of tiers, rows (along y) and columns (along x).
    of
        Region of each waypoint, as an index of a flattened array of this shape, shape (N,).
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
        """Return the sum over each region of a value per waypoint, shape `shape`."""
        cells = int(np.prod(self.shape))
        sums: NDArray[np.float64] = np.bincount(self.of, values, cells).astype(np.float64)
        return sums.reshape(self.shape)


class Density:
    """A quantity per metre of way in each region, which is added up along trips.

    Parameters
    ----------
    regions
        The regions of the floor.
    per_metre
        The quantity in each region, shape `regions.shape`.
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
        """Return the sums along straight trips from a waypoint to n others, shape (n,).

        A trip goes along one axis and then along the other; the result is the mean over both
        sequences. Waypoints on another tier are treated as if they were on the tier of the first.
        """
        regions = self._regions
        rows, columns = regions.row[others], regions.column[others]
        row, column = regions.row[waypoint], regions.column[waypoint]
        x_first = np.abs(self._to_x(waypoint, row, others) - self._to_x(waypoint, row, waypoint))
        x_first += np.abs(
            self._to_y(waypoint, columns, others) - self._to_y(waypoint, columns, waypoint)
        )
        y_first = np.abs(
            self._to_y(waypoint, column, others) - self._to_y(waypoint, column, waypoint)
        )
        y_first += np.abs(self._to_x(waypoint, rows, others) - self._to_x(waypoint, rows, waypoint))
        total: NDArray[np.float64] = 0.5 * (x_first + y_first)
        return total

    def _to_x(
        self,
        waypoint: int,
        row: NDArray[np.intp] | np.intp,
        at: NDArray[np.integer] | int,
    ) -> NDArray[np.float64]:
        """Return the sum in a row from its beginning to the x of waypoints."""
        regions, tier = self._regions, self._regions.tier[waypoint]
        column = regions.column[at]
        part = (regions.x[at] - column) * self._crossed[tier, row, column]
        whole: NDArray[np.float64] = self._by_x[tier, row, column] + part
        return whole

    def _to_y(
        self,
        waypoint: int,
        column: NDArray[np.intp] | np.intp,
        at: NDArray[np.integer] | int,
    ) -> NDArray[np.float64]:
        """Return the sum in a column from its beginning to the y of waypoints."""
        regions, tier = self._regions, self._regions.tier[waypoint]
        row = regions.row[at]
        part = (regions.y[at] - row) * self._crossed[tier, row, column]
        whole: NDArray[np.float64] = self._by_y[tier, row, column] + part
        return whole
