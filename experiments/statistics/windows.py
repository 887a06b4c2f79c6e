"""Rates within a part of a run, for example after a warm-up, or before and after a change."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.statistics.intervals import require

if TYPE_CHECKING:
    from collections.abc import Sequence


def rates(
    series: pd.DataFrame,
    columns: Sequence[str],
    *,
    start_s: float = 0.0,
    end_s: float = float("inf"),
    keys: Sequence[str] = ("arm", "replication"),
) -> pd.DataFrame:
    """Return hourly rates within a time window, for every run.

    Only intervals of the time series that lie completely within the window are counted.

    Parameters
    ----------
    series
        The table `series` of runs (`experiments.load(DIR, table="series")`).
    columns
        Columns with amounts per interval, such as `orders_completed` and `distance_m`.
    start_s, end_s
        Start and end of the window, in s since the start of the runs.
    keys
        Columns that identify runs.

    Returns
    -------
    One row per run: the keys, and the amount per hour of each column, which is nan if
    the run has no amounts.

    Raises
    ------
    InputError
        If no interval lies in the window.
    """
    require(series, *keys, "time_s", "interval_s", *columns)
    begin = series["time_s"] - series["interval_s"]
    inside = series[(begin >= start_s - 1e-6) & (series["time_s"] <= end_s + 1e-6)]
    if inside.empty:
        raise InputError(f"window {start_s:g} to {end_s:g} s: no interval of the runs lies in it")
    sums = inside.groupby(list(keys), sort=False)[[*columns, "interval_s"]].sum(min_count=1)
    per_hour = sums[list(columns)].div(sums["interval_s"] / 3600.0, axis=0)
    return per_hour.reset_index()
