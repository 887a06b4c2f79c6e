"""Convergence of a rate, such as units picked per hour, for choosing the length of a warm-up."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout import colours
from rmfs.measure.plots.hours import hours
from rmfs.measure.warmup import mser, settled, welch

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

HAIR_S = 1e-6
"""Tolerance for rounding errors in the length of an interval, in s."""


def warmup(series: pd.DataFrame, ax: Axes, *, column: str = "units_picked") -> None:
    """Plot a rate in each minute, its moving average, and two proposals for the warm-up.

    One proposal is by MSER-5, the other by Welch's method (`rmfs.measure.warmup`). The series
    starts after the run's own warm-up, so use a run with `warmup_s = 0`. The last interval is left
    out if it is shorter than the others, since its rate varies more.

    Parameters
    ----------
    series
        The table `series` of a run.
    column
        Column with a count for each minute; the counts are plotted as rates per hour.
    """
    if series["interval_s"].iloc[-1] < series["interval_s"].iloc[0] - HAIR_S:
        series = series.iloc[:-1]
    rate = (series[column] / series["interval_s"] * 3600.0).to_numpy(float)
    time_h = series["time_s"].to_numpy() / 3600.0
    start_h = time_h[0] - float(series["interval_s"].iloc[0]) / 3600.0
    ax.plot(time_h, rate, color=colours.HALLWAY, linewidth=0.5, label="per minute")
    proposals = [("MSER-5", mser(rate), "--")]
    if len(rate) >= 8:
        window = max(len(rate) // 8, 1)
        smooth = welch(rate, window)
        ax.plot(
            time_h[: len(smooth)],
            smooth,
            color=colours.STORAGE,
            label=f"moving average of {2 * window + 1}",
        )
        proposals.append(("Welch", settled(smooth), ":"))
    for name, drop, style in proposals:
        if drop is None:
            ax.plot([], [], color=colours.OUTLINE, linestyle=style, label=f"{name}: not settled")
            continue
        end_h = time_h[drop - 1] if drop else start_h
        label = f"{name}: {end_h * 3600.0:.0f} s"
        ax.axvline(end_h, color=colours.OUTLINE, linestyle=style, label=label)
    ax.set_ylim(0, 1.08 * ax.get_ylim()[1])
    hours(ax)
    ax.set_ylabel(f"{column.replace('_', ' ')} (1/h)")
    ax.legend(loc="lower right")
