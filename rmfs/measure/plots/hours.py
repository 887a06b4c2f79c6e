"""Time axes in hours, and rates per hour."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def hours(ax: Axes) -> None:
    """Label the horizontal axis as time in h, and remove its margins."""
    ax.set_xlabel("time (h)")
    ax.margins(x=0)


def per_hour(series: pd.DataFrame, column: str, bin_s: float) -> tuple[Floats, Floats]:
    """Return the hourly rates of the counts in a column of `series`, averaged over time bins.

    Parameters
    ----------
    bin_s
        Minimum length of a bin in s. A series shorter than three such bins is divided into at most
        three shorter bins.

    Returns
    -------
    tuple
        Midpoint of each bin in h, and rate in each bin in 1/h.
    """
    end, length = series["time_s"].to_numpy(), series["interval_s"].to_numpy()
    begin_s, total_s = float(end[0] - length[0]), float(length.sum())
    number = max(int(total_s // max(min(bin_s, total_s / 3), length[0])), 1)
    edges = np.linspace(0, len(series), min(number, len(series)) + 1).round().astype(int)[:-1]
    spans = np.add.reduceat(length, edges)
    counts = np.add.reduceat(series[column].to_numpy(float), edges)
    middle = begin_s + np.cumsum(spans) - spans / 2
    return middle / 3600.0, counts / spans * 3600.0
