"""Progression plot: a measure over time, as the mean over the seeds with a confidence band."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import stats

from rmfs.experiments.figures.style import COLOURS
from rmfs.experiments.statistics.intervals import require

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    from matplotlib.axes import Axes


def progression(
    series: pd.DataFrame,
    column: str,
    ax: Axes,
    *,
    bin_s: float = 3600.0,
    confidence: float = 0.95,
    colours: Mapping[Any, str] | None = None,
    label: str = "{arm}",
    style: str = "-",
) -> None:
    """Draw the hourly rate of a count over time, with one line per arm.

    Parameters
    ----------
    series
        The table `series` of runs (`experiments.load(DIR, table="series")`).
    column
        Column of `series` that counts events per interval, such as `orders_completed`.
    bin_s
        Time covered by one point, in s. Default: an hour.
    label
        Legend entry, in which `{arm}` stands for the name of the arm.
    style
        Line style.
    """
    found = per_bin(series, column, bin_s)
    for number, (arm, one) in enumerate(found.groupby("arm", sort=False)):
        wide = one.pivot_table(index="hour", columns="replication", values="rate")
        count = wide.shape[1]
        mean = wide.mean(axis=1)
        colour = (colours or {}).get(arm, COLOURS[number % len(COLOURS)])
        ax.plot(mean.index, mean, style, color=colour, label=label.format(arm=arm), linewidth=1.5)
        if count > 1:
            quantile = stats.t.ppf((1 + confidence) / 2, count - 1)
            half = quantile * wide.std(axis=1, ddof=1) / np.sqrt(count)
            ax.fill_between(mean.index, mean - half, mean + half, color=colour, alpha=0.2, lw=0)
    ax.set_xlabel("time (h)")


def per_bin(series: pd.DataFrame, column: str, bin_s: float) -> pd.DataFrame:
    """Return the hourly rate of a count for each run and each bin of time.

    The columns are `arm`, `replication`, `hour` (the middle of the bin) and `rate`, which is nan if
    the run has no counts. An incomplete last bin is left out.
    """
    require(series, "arm", "replication", "time_s", "interval_s", column)
    middle = series["time_s"] - series["interval_s"] / 2
    number = np.floor(middle / bin_s).astype(int)
    keys = [series["arm"], series["replication"], number.rename("bin")]
    sums = series[[column, "interval_s"]].groupby(keys, sort=False).sum(min_count=1)
    sums = sums.reset_index()
    full = sums[sums["interval_s"] >= bin_s * (1 - 1e-9)]
    return full.assign(
        hour=(full["bin"] + 0.5) * bin_s / 3600.0,
        rate=full[column] / full["interval_s"] * 3600.0,
    )[["arm", "replication", "hour", "rate"]]
