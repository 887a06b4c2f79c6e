"""Picked units and distance per hour over time (paper, figure 5a)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout import colours
from rmfs.measure.plots.hours import hours, per_hour

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def progression(series: pd.DataFrame, ax: Axes, *, bin_s: float = 600.0) -> None:
    """Draw units per hour as a solid line, km per hour as a dashed one on an axis of its own.

    Parameters
    ----------
    series
        The table `series` of a run.
    bin_s
        Length of time that is summed up into one point.
    """
    time_h, units = per_hour(series, "units_picked", bin_s)
    _, metres = per_hour(series, "distance_m", bin_s)
    (picked,) = ax.plot(time_h, units, color=colours.PICK_STATION, label="units picked")
    right = ax.twinx()
    (driven,) = right.plot(
        time_h, metres / 1000.0, color=colours.STORAGE, linestyle="--", label="distance"
    )
    ax.set_ylim(0, 1.08 * ax.get_ylim()[1])
    right.set_ylim(0, 1.08 * right.get_ylim()[1])
    hours(ax)
    ax.set_ylabel("units picked (1/h)")
    right.set_ylabel("distance (km/h)")
    ax.legend(handles=[picked, driven], loc="lower right")
