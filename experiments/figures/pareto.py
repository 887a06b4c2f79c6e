"""Two goals at once: arms that no other arm beats in both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.experiments.figures.style import COLOURS, axis_label
from rmfs.experiments.statistics import per_arm

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

Goal = Literal["max", "min"]


def front(x: pd.Series, y: pd.Series, x_goal: Goal = "min", y_goal: Goal = "max") -> list[str]:
    """Return the arms that no other one dominates, in the order of x.

    An arm dominates another if it is at least as good in both goals and better in one.

    Parameters
    ----------
    x, y
        Means, indexed by arm.
    """
    a = x.to_numpy(float) * (1 if x_goal == "max" else -1)
    b = y.reindex(x.index).to_numpy(float) * (1 if y_goal == "max" else -1)
    no_worse = (a[:, None] >= a[None, :]) & (b[:, None] >= b[None, :])
    better = (a[:, None] > a[None, :]) | (b[:, None] > b[None, :])
    beaten = (no_worse & better).any(axis=0)
    left = x.loc[~np.asarray(beaten)]
    return list(left.sort_values(kind="stable").index)


def pareto(
    frame: pd.DataFrame,
    x: str,
    y: str,
    ax: Axes,
    *,
    x_goal: Goal = "min",
    y_goal: Goal = "max",
    confidence: float = 0.95,
    by: str = "arm",
) -> list[str]:
    """Draw means of two columns with their intervals, and the front of the best compromises.

    Returns
    -------
    The arms on the front.
    """
    across = per_arm(frame, x, confidence=confidence, by=by)
    upward = per_arm(frame, y, confidence=confidence, by=by)
    ax.errorbar(
        across["mean"],
        upward["mean"],
        xerr=across["half_width"].fillna(0.0),
        yerr=upward["half_width"].fillna(0.0),
        fmt="o",
        color="0.55",
        markersize=4,
        capsize=2,
        linewidth=1,
    )
    best = front(across["mean"], upward["mean"], x_goal, y_goal)
    line = np.array([[across["mean"][arm], upward["mean"][arm]] for arm in best])
    ax.plot(line[:, 0], line[:, 1], "o-", color=COLOURS[1], markersize=5, zorder=3)
    for (x_mean, y_mean), arms in _at_same_place(best, line).items():
        ax.annotate(
            "\n".join(arms),
            (x_mean, y_mean),
            textcoords="offset points",
            xytext=(5, -5),
            va="top",
            fontsize=7,
        )
    ax.margins(x=0.15, y=0.1)
    ax.set_xlabel(axis_label(x))
    ax.set_ylabel(axis_label(y))
    return best


def _at_same_place(
    best: list[str], line: NDArray[np.float64]
) -> dict[tuple[float, float], list[str]]:
    """Return the arms of the front by their point, so that no label covers another."""
    places: dict[tuple[float, float], list[str]] = {}
    for arm, (x_mean, y_mean) in zip(best, line, strict=True):
        places.setdefault((float(x_mean), float(y_mean)), []).append(str(arm))
    return places
