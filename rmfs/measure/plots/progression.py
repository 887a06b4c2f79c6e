"""Rates over time: units picked per hour, and km driven per hour by all robots.

As in figure 5a of Merschformann, Xie and Li (2018).
"""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from rmfs.layout import colours
from rmfs.measure.plots.hours import hours, per_hour

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def progression(
    series: pd.DataFrame, ax: Axes, *, bin_s: float = 600.0, bound_per_h: float | None = None
) -> None:
    """Plot units picked per hour (solid) and, on a second axis, km driven per hour (dashed).

    Parameters
    ----------
    series
        The table `series` of a run.
    bin_s
        Minimum length of the time bins in s. A series shorter than three such bins is divided into
        at most three shorter bins.
    bound_per_h
        Upper bound on units picked per hour, drawn as a dotted line. Default: no bound.
    """
    time_h, units = per_hour(series, "units_picked", bin_s)
    _, metres = per_hour(series, "distance_m", bin_s)
    (picked,) = ax.plot(time_h, units, color=colours.PICK_STATION, label="units picked")
    right = ax.twinx()
    (driven,) = right.plot(
        time_h, metres / 1000.0, color=colours.STORAGE, linestyle="--", label="distance"
    )
    lines = [picked, driven]
    if bound_per_h is not None and isfinite(bound_per_h):
        label = "bound on units picked"
        lines.append(ax.axhline(bound_per_h, color=colours.OUTLINE, linestyle=":", label=label))
    ax.set_ylim(0, 1.08 * ax.get_ylim()[1])
    right.set_ylim(0, 1.08 * right.get_ylim()[1])
    hours(ax)
    ax.set_ylabel("units picked (1/h)")
    right.set_ylabel("distance (km/h)")
    ax.legend(handles=lines, loc="lower right")
