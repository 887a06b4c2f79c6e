"""States of robots over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout import colours
from rmfs.measure.plots.hours import hours

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

STATES = {
    "moving": ("driving", "driving", ""),
    "turning": ("turning", "turning", "//"),
    "riding": ("in an elevator", "in an elevator", ""),
    "transfer": ("lifting, setting down", "lifting, setting down", "xx"),
    "served": ("at a station", "served", ".."),
    "waiting": ("waiting, queueing", "waiting", ""),
    "idle": ("idle", "idle", "oo"),
}
"""Label, name of the colour, and hatch of each state, from bottom to top."""


def robots(series: pd.DataFrame, ax: Axes) -> None:
    """Draw the mean number of robots in each state, stacked, from a table `series`."""
    shown = [state for state in STATES if series[f"robots_{state}"].any()]
    areas = ax.stackplot(
        series["time_s"] / 3600.0,
        [series[f"robots_{state}"].to_numpy() for state in shown],
        colors=[colours.STATES[STATES[state][1]] for state in shown],
        labels=[STATES[state][0] for state in shown],
        edgecolor=colours.OUTLINE,
        linewidth=0.3,
    )
    for area, state in zip(areas, shown, strict=True):
        area.set_hatch(STATES[state][2])
    hours(ax)
    ax.set_ylabel("robots")
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1, 0.5))
