"""Line plot: the mean of a measure, with its interval, at each value of a numerical column."""

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
    """Draw the mean of a measure at each value of `x`, with one line per value of `by`.

    Parameters
    ----------
    frame
        Results, as `experiments.load` returns them.
    x
        A numerical column with several runs per value.
    column
        The measure.
    by
        Column; one line is drawn for each of its values.
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
