"""Main effects: the mean at each level of each factor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.experiments.figures.style import COLOURS, axis_label, levels
from rmfs.experiments.statistics import interval

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from matplotlib.axes import Axes


def effects(
    frame: pd.DataFrame,
    column: str,
    factors: Sequence[str],
    axes: Sequence[Axes],
    *,
    names: Sequence[str] | None = None,
    confidence: float = 0.95,
) -> None:
    """Draw the main effect of every factor: the mean of a column at each level.

    For the confidence interval of a level, the column is first averaged, seed by seed, over all
    arms with this level. The interval is valid for these arms only, not for other possible arms.

    Parameters
    ----------
    axes
        One `Axes` object for each factor; all of them should share the y axis.
    names
        Displayed names of the factors. Default: as in the frame.
    """
    for number, (factor, ax) in enumerate(zip(factors, axes, strict=True)):
        rows = levels(frame, factor)
        found = [
            interval(mine.groupby("replication")[column].mean(), confidence)
            for mine in rows.values()
        ]
        means = [one.mean for one in found]
        halves = [0.0 if one.half_width != one.half_width else one.half_width for one in found]
        ax.errorbar(range(len(rows)), means, yerr=halves, fmt="o-", color=COLOURS[0], capsize=3)
        ax.axhline(float(frame[column].mean()), color="0.6", linewidth=0.8, zorder=0)
        ax.set_xticks(range(len(rows)), list(rows), rotation=45, ha="right")
        ax.set_xlim(-0.5, len(rows) - 0.5)
        ax.set_title(names[number] if names is not None else factor, fontsize=9)
    axes[0].set_ylabel(axis_label(column))
