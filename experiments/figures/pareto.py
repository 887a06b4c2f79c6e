"""Pareto plot of two measures, with the arms that no other arm dominates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.figures.style import COLOURS, axis_label
from rmfs.experiments.statistics import per_arm
from rmfs.measure.dictionary import better_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

Goal = Literal["more", "less"]

ARROWS = {"more": ("→", "↑"), "less": ("←", "↓")}
"""Arrows that point to the better side of the x and the y axis."""


def front(x: pd.Series, y: pd.Series, x_goal: Goal, y_goal: Goal) -> list[str]:
    """Return the arms that no other arm dominates, sorted by x.

    An arm dominates another if it is at least as good in both measures and better in one. Arms
    without a value in one of the measures are left out.

    Parameters
    ----------
    x, y
        Means, indexed by arm.
    """
    both = pd.concat([x, y.reindex(x.index)], axis=1, keys=["x", "y"]).dropna()
    a = both["x"].to_numpy(float) * (1 if x_goal == "more" else -1)
    b = both["y"].to_numpy(float) * (1 if y_goal == "more" else -1)
    no_worse = (a[:, None] >= a[None, :]) & (b[:, None] >= b[None, :])
    better = (a[:, None] > a[None, :]) | (b[:, None] > b[None, :])
    beaten = (no_worse & better).any(axis=0)
    left = both["x"].loc[~np.asarray(beaten)]
    return list(left.sort_values(kind="stable").index)


def pareto(
    frame: pd.DataFrame,
    x: str,
    y: str,
    ax: Axes,
    *,
    x_goal: Goal | None = None,
    y_goal: Goal | None = None,
    confidence: float = 0.95,
    by: str = "arm",
) -> list[str]:
    """Draw the means of two columns for each arm with their intervals, and the Pareto front.

    Parameters
    ----------
    x_goal, y_goal
        Whether `more` or `less` is better, for each of the two columns. Default: from the data
        dictionary.

    Returns
    -------
    The arms on the front.

    Raises
    ------
    InputError
        If a column has no goal in the data dictionary and none is given.
    """
    goals = (goal_of(x, x_goal), goal_of(y, y_goal))
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
    best = front(across["mean"], upward["mean"], *goals)
    line = np.array([[across["mean"][arm], upward["mean"][arm]] for arm in best]).reshape(-1, 2)
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
    ax.set_xlabel(f"{axis_label(x)}, {goals[0]} is better {ARROWS[goals[0]][0]}")
    ax.set_ylabel(f"{axis_label(y)}, {goals[1]} is better {ARROWS[goals[1]][1]}")
    return best


def goal_of(column: str, stated: Goal | None = None) -> Goal:
    """Return `more` or `less`: which of them is better for a column.

    This is `stated` or, if `stated` is None, the goal in the data dictionary.

    Raises
    ------
    InputError
        If no goal is stated, and the data dictionary has none.
    """
    if stated is not None:
        return stated
    better = better_of(column)
    if better == "neither":
        raise InputError(
            f"column {column}: the data dictionary states no goal; give one: --goal "
            f"{column}=more or --goal {column}=less"
        )
    return better


def _at_same_place(
    best: list[str], line: NDArray[np.float64]
) -> dict[tuple[float, float], list[str]]:
    """Group the arms of the front that have the same point, so that no label covers another."""
    places: dict[tuple[float, float], list[str]] = {}
    for arm, (x_mean, y_mean) in zip(best, line, strict=True):
        places.setdefault((float(x_mean), float(y_mean)), []).append(str(arm))
    return places
