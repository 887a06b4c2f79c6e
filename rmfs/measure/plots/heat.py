"""Heat map of where robots drive and wait, as in figure 5b of Merschformann, Xie and Li (2018)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.collections import PatchCollection
from matplotlib.colors import LogNorm
from matplotlib.patches import Rectangle

from rmfs.errors import InputError
from rmfs.measure.tables.motion import HEAT

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

SIDE_M = 1.0
"""Side length of the square drawn for a waypoint, in m: the usual distance between neighbours."""

UNUSED = "0.94"
"""Grey of waypoints with a zero count."""


def heat(frame: pd.DataFrame, ax: Axes, *, column: str = "visits", tier: int = 0) -> None:
    """Plot a count or time for every waypoint of a tier, in colours on a logarithmic scale.

    Greater values have darker colours, so that the plot is also readable in greyscale.

    Parameters
    ----------
    frame
        The table `heat` of a run.
    column
        A count or time of the table, such as `visits`, `loaded_visits` or `pick_waiting_s`.
    tier
        Index of the tier. Default 0.

    Raises
    ------
    InputError
        If there is no such column.
    """
    counts = {one.name: one for one in HEAT[4:]}
    if column not in counts:
        raise InputError(f"heat map of {column}: unknown column; valid: {', '.join(counts)}")
    here = frame[frame["tier"] == tier]
    used = here[column] > 0
    ax.add_collection(_squares(here[~used], facecolor=UNUSED))
    if used.any():
        values = here.loc[used, column].to_numpy(float)
        squares = _squares(here[used], cmap="magma_r", norm=LogNorm(values.min(), values.max()))
        squares.set_array(values)
        ax.add_collection(squares)
        label = f"{counts[column].meaning.split(',')[0]} ({counts[column].unit})"
        ax.figure.colorbar(squares, ax=ax, label=label, shrink=0.8)
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")


def _squares(waypoints: pd.DataFrame, **style: object) -> PatchCollection:
    corners = zip(waypoints["x_m"] - SIDE_M / 2, waypoints["y_m"] - SIDE_M / 2, strict=True)
    patches = [Rectangle(corner, SIDE_M, SIDE_M) for corner in corners]
    return PatchCollection(patches, linewidth=0, **style)  # type: ignore[arg-type]
