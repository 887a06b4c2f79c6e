"""Utilisation of each station."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.layout import colours

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


def stations(frame: pd.DataFrame, ax: Axes) -> None:
    """Draw a bar for the busy share of each station, from a table `stations`.

    The bars of replenishment stations are hatched.
    """
    for kind, colour, hatch in (
        ("pick", colours.PICK_STATION, ""),
        ("replenishment", colours.REPLENISHMENT_STATION, "//"),
    ):
        own = frame[frame["kind"] == kind]
        busy = 100.0 * (1.0 - own["idle_share"])
        style: dict[str, Any] = {"edgecolor": colours.OUTLINE, "linewidth": 0.5, "hatch": hatch}
        ax.bar(own["station"], busy, color=colour, label=f"{kind} stations", **style)
    ax.set_ylim(0, 100)
    ax.set_xlabel("station")
    ax.set_ylabel("busy (% of the time)")
    ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))
