"""Interval plot: the single runs of each arm, their mean and its confidence interval."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.experiments.figures.style import COLOURS, axis_label
from rmfs.experiments.statistics import per_arm

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from rmfs.experiments.statistics.intervals import Method

SPREAD = 0.25
"""Maximum distance of a dot from the middle of its row, in rows."""


def intervals(
    frame: pd.DataFrame,
    column: str,
    ax: Axes,
    *,
    confidence: float = 0.95,
    method: Method = "t",
    by: str = "arm",
) -> None:
    """Draw one row per arm: a dot for each seed, the mean and its confidence interval.

    The dot of a given seed is at the same height within every row, so that runs with the same
    seed can be recognised.

    Parameters
    ----------
    frame
        Results, as `experiments.load` returns them.
    """
    found = per_arm(frame, column, confidence=confidence, method=method, by=by)
    seeds = sorted(frame["replication"].unique())
    heights = dict(zip(seeds, np.linspace(-SPREAD, SPREAD, max(len(seeds), 2)), strict=False))
    for row, arm in enumerate(found.index):
        runs = frame[frame[by] == arm]
        y = [row + heights[seed] for seed in runs["replication"]]
        ax.plot(runs[column], y, ".", color=COLOURS[0], alpha=0.45, markersize=5, linewidth=0)
    errors = found["half_width"].fillna(0.0)
    if method == "t":
        ax.errorbar(found["mean"], range(len(found)), xerr=errors, **_MARK)
    else:
        sides = np.stack([found["mean"] - found["low"], found["high"] - found["mean"]])
        ax.errorbar(found["mean"], range(len(found)), xerr=np.nan_to_num(sides), **_MARK)
    ax.set_yticks(range(len(found)), [str(arm) for arm in found.index])
    ax.set_ylim(len(found) - 0.5, -0.5)
    ax.set_xlabel(axis_label(column))


_MARK: dict[str, Any] = {
    "fmt": "o",
    "color": COLOURS[1],
    "markersize": 5,
    "capsize": 3,
    "linewidth": 1.5,
    "zorder": 3,
}
