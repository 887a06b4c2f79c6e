"""Breakdown of the turnover time of orders, by the time of their completion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout import colours
from rmfs.measure.plots.hours import hours
from rmfs.measure.tables.delays import PARTS

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

LABELS = {
    "wait_assignment": ("waiting for a station", colours.STATES["idle"], ""),
    "wait_pod": ("waiting for a pod", colours.FREE_STORAGE, ""),
    "wait_robot": ("waiting for a robot", colours.STORAGE, ""),
    "wait_plan": ("waiting for a plan", colours.QUEUE_ZONE, "\\\\"),
    "drive_free": ("driving", colours.STATES["driving"], ""),
    "drive_hindered": ("hindered by others", colours.STATES["waiting"], "//"),
    "queue": ("queueing", colours.STATES["queueing"], ""),
    "service": ("served", colours.STATES["served"], ".."),
    "wait_order": ("waiting for the rest of the order", colours.ELEVATOR, "xx"),
}
"""Label, colour and hatch of each part, from bottom to top."""

BINS = 24


def delays(orders: pd.DataFrame, ax: Axes) -> None:
    """Plot the mean of each part of order turnover, stacked, against the time of completion.

    Parameters
    ----------
    orders
        The table `delays`, which has a column for each part.
    """
    each = orders.groupby("order").mean(numeric_only=True)
    ended = each["completed_s"].to_numpy() / 3600.0
    if not len(ended):
        ax.text(0.5, 0.5, "no order was completed", ha="center", transform=ax.transAxes)
        return
    edges = np.linspace(ended.min(), max(ended.max(), ended.min() + 1e-6), BINS + 1)
    which = np.clip(np.searchsorted(edges, ended, side="right") - 1, 0, BINS - 1)
    number = np.maximum(np.bincount(which, minlength=BINS), 1)
    below = np.zeros(BINS)
    for part in PARTS:
        label, colour, hatch = LABELS[part]
        seconds = each[f"{part}_s"].to_numpy()
        minutes = np.bincount(which, weights=seconds, minlength=BINS) / number / 60.0
        ax.bar(
            edges[:-1],
            minutes,
            np.diff(edges),
            bottom=below,
            align="edge",
            label=label,
            color=colour,
            hatch=hatch,
            edgecolor=colours.OUTLINE,
            linewidth=0.3,
        )
        below += minutes
    hours(ax)
    ax.set_ylabel("order turnover in min")
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1, 0.5))
