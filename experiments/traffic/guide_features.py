"""Features of edges; the extra cost of an edge is the weighted sum of its features."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

FEATURES = ("against", "across", "storage", "entrance", "flow", "waiting")
"""Features of an edge, each between 0 and 1 or, for `waiting`, up to `LONG_S`:

- `against`: on a two-way aisle, whether the edge leads against the direction that this aisle would
  have if the aisles along x, and those along y, were alternately one-way
- `across`: whether the edge lies on an aisle along x; the others lie along y
- `storage`: whether the edge ends at a storage location
- `entrance`: whether the edge lies on an aisle and ends within `NEAR_M` of the entrance of a queue
- `flow`: how often the edge was driven in an earlier run, relative to the edge driven most often
- `waiting`: on an aisle, the mean time in s for which a robot waited at the end of the edge in an
  earlier run, over all visits there, whichever edge the robot came by
"""

NEAR_M = 3.0
"""Distance from the entrance of a queue, in m, within which an edge counts as close to it."""

LONG_S = 10.0
"""Limit of the feature `waiting`, in s."""

FEW = 5.0
"""Visits without waiting that are added to those counted, so that a few mean little."""


def features(
    layout: Layout, edges: pd.DataFrame, heat: pd.DataFrame
) -> dict[str, NDArray[np.float64]]:
    """Return, by name, the features of all edges, shape (M,), in the order of `layout.edge_target`.

    Parameters
    ----------
    edges, heat
        The tables `edges` and `heat` of an earlier run, or of several runs (concatenated).
    """
    tails, heads = edge_sources(layout), layout.edge_target
    aisle = ~(layout.is_storage | layout.is_queue)
    on_aisle = aisle[tails] & aisle[heads]
    dx, dy = layout.x_m[heads] - layout.x_m[tails], layout.y_m[heads] - layout.y_m[tails]
    along_x = np.abs(dx) > np.abs(dy)
    two_way = on_aisle & np.isin(_key(layout, tails, heads), _key(layout, heads, tails))
    odd_row, odd_column = _rank(layout.y_m, aisle) % 2, _rank(layout.x_m, aisle) % 2
    backwards = np.where(
        along_x, (dx < 0) ^ (odd_row[tails] == 1), (dy < 0) ^ (odd_column[tails] == 1)
    )
    flow = np.zeros(len(heads))
    driven = edges.groupby(["from_waypoint", "to_waypoint"])["passages"].sum()
    places = {pair: at for at, pair in enumerate(zip(tails.tolist(), heads.tolist(), strict=True))}
    for pair, count in driven.items():
        if pair in places:
            flow[places[pair]] = count
    waited = heat.groupby("waypoint")[["visits", "waiting_s"]].sum()
    waiting = np.zeros(layout.waypoints)
    waiting[waited.index] = waited["waiting_s"] / (waited["visits"] + FEW)
    near = _near_entrances(layout)
    return {
        "against": (two_way & backwards).astype(np.float64),
        "across": (on_aisle & along_x).astype(np.float64),
        "storage": layout.is_storage[heads].astype(np.float64),
        "entrance": (on_aisle & near[heads]).astype(np.float64),
        "flow": flow / max(flow.max(), 1.0) * on_aisle,
        "waiting": np.minimum(waiting[heads], LONG_S) * on_aisle,
    }


def _key(layout: Layout, tails: NDArray[np.int32], heads: NDArray[np.int32]) -> NDArray[np.int64]:
    return tails.astype(np.int64) * layout.waypoints + heads


def _rank(values: NDArray[np.float64], among: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return the rank of each value among the distinct values of some waypoints."""
    distinct = np.unique(np.round(values[among], 3))
    return np.searchsorted(distinct, np.round(values, 3))


def _near_entrances(layout: Layout) -> NDArray[np.bool_]:
    near = np.zeros(layout.waypoints, dtype=bool)
    for station in layout.stations:
        entrance = station.queue[-1]
        distance = np.abs(layout.x_m - layout.x_m[entrance])
        distance = distance + np.abs(layout.y_m - layout.y_m[entrance])
        near |= (distance <= NEAR_M) & (layout.tier == layout.tier[entrance])
    return near
