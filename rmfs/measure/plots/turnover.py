"""Distribution of order turnover times."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout import colours

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def turnover(orders: pd.DataFrame, ax: Axes) -> None:
    """Draw the distribution of order turnover, with its median, from a table `orders`."""
    minutes = orders["turnover_s"].dropna() / 60.0
    ax.set_xlabel("order turnover (min)")
    ax.set_ylabel("orders")
    if minutes.empty:
        return
    ax.hist(minutes, bins="auto", color=colours.STORAGE, edgecolor=colours.OUTLINE, linewidth=0.5)
    median = float(minutes.median())
    ax.axvline(median, color=colours.OUTLINE, linestyle="--", label=f"median {median:.1f} min")
    ax.legend()
