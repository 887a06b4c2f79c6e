"""Backlogs and open orders over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout import colours
from rmfs.measure.plots.hours import hours

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def backlog(series: pd.DataFrame, ax: Axes) -> None:
    """Plot waiting orders, open orders and waiting bundles over time, from a table `series`."""
    time_h = series["time_s"] / 3600.0
    for column, label, colour, style in (
        ("backlog_orders", "orders waiting", colours.PICK_STATION, "-"),
        ("open_orders", "orders at stations", colours.ROBOT, "--"),
        ("backlog_bundles", "bundles waiting", colours.STORAGE, ":"),
    ):
        ax.plot(time_h, series[column], color=colour, linestyle=style, label=label)
    ax.set_ylim(bottom=0)
    hours(ax)
    ax.set_ylabel("number")
    ax.legend()
