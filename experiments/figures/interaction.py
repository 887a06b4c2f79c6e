"""Interaction plot: whether the effect of one factor depends on the level of another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.experiments.figures.style import COLOURS, axis_label, levels
from rmfs.experiments.statistics import interval

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

SPREAD = 0.24
"""Width over which the lines at one level are spread, in levels."""

STYLES = ("-", "--", ":")
"""Line styles, used if there are more lines than colours."""


def interaction(
    frame: pd.DataFrame,
    column: str,
    across: str,
    by: str,
    ax: Axes,
    *,
    names: tuple[str, str] | None = None,
    confidence: float = 0.95,
    legend: bool = True,
) -> None:
    """Draw the mean of a column at each level of `across`, with one line per level of `by`.

    Parallel lines mean that there is no interaction. For the confidence interval of a point, the
    column is first averaged, seed by seed, over all arms with the point's two levels. Combinations
    missing from the design leave gaps.

    Parameters
    ----------
    across
        Factor along the x axis.
    by
        Factor with one line per level.
    names
        Displayed names of the factors `across` and `by`. Default: as in the frame.
    legend
        Whether to draw a legend of the lines. Default: yes.
    """
    called = names if names is not None else (across, by)
    places = list(levels(frame, across))
    lines = levels(frame, by)
    for number, (line, mine) in enumerate(lines.items()):
        rows = levels(mine, across)
        found = [
            interval(rows[place].groupby("replication")[column].mean(), confidence)
            if place in rows
            else interval([])
            for place in places
        ]
        shift = SPREAD * ((number + 0.5) / len(lines) - 0.5)
        ax.errorbar(
            np.arange(len(places)) + shift,
            [one.mean for one in found],
            yerr=np.nan_to_num([one.half_width for one in found]),
            marker="o",
            color=COLOURS[number % len(COLOURS)],
            linestyle=STYLES[number // len(COLOURS) % len(STYLES)],
            label=line,
            markersize=4,
            linewidth=1,
            capsize=2,
        )
    ax.set_xticks(range(len(places)), places, rotation=45, ha="right")
    ax.set_xlim(-0.5, len(places) - 0.5)
    ax.set_xlabel(called[0])
    ax.set_ylabel(axis_label(column))
    if legend:
        ax.legend(title=called[1], fontsize=7, title_fontsize=7)
