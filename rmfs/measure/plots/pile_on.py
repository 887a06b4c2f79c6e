"""Distribution of the units picked per visit of a pod."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.layout import colours

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def pile_on(visits: pd.DataFrame, ax: Axes) -> None:
    """Draw the distribution of units per visit, with its mean, from a table `visits`."""
    units = visits["units"][visits["units"] > 0].to_numpy()
    ax.set_xlabel("units picked per visit")
    ax.set_ylabel("visits")
    if not len(units):
        return
    number, times = np.unique(units, return_counts=True)
    style: dict[str, Any] = {"edgecolor": colours.OUTLINE, "linewidth": 0.5}
    ax.bar(number, times, width=1.0, color=colours.PICK_STATION, **style)
    mean = float(units.mean())
    ax.axvline(mean, color=colours.OUTLINE, linestyle="--", label=f"mean {mean:.2f}")
    ax.legend()
