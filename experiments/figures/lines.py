"""Means over a number, as lines with their intervals."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.experiments.figures.style import COLOURS, axis_label
from rmfs.experiments.statistics import per_arm

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def lines(
    frame: pd.DataFrame, x: str, column: str, by: str, ax: Axes, *, confidence: float = 0.95
) -> None:
    """Draw a line per level of a factor: means of a measure over another column.

    Parameters
    ----------
    frame
        Results, as `experiments.load` returns them.
    x
        A column of numbers that the runs have in groups.
    column
        The measure.
    by
        Column whose levels get a line each.
    """
    for number, level in enumerate(frame[by].unique()):
        runs = frame[frame[by] == level]
        found = per_arm(runs, column, confidence=confidence, by=x).sort_index()
        ax.errorbar(
            found.index.to_numpy(dtype=float),
            found["mean"],
            yerr=found["half_width"].fillna(0.0),
            label=str(level),
            color=COLOURS[number % len(COLOURS)],
            marker="o",
            markersize=4,
            capsize=3,
        )
    ax.set_ylabel(axis_label(column))
