"""Compressed sparse rows for the waypoint graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout


def compressed(
    waypoints: int, edges: Iterable[tuple[int, int]]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return `edge_start` and `edge_target` of a layout for directed edges, each kept once."""
    pairs = np.array(sorted(set(edges)), dtype=np.int32).reshape(-1, 2)
    start = np.zeros(waypoints + 1, dtype=np.int32)
    np.cumsum(np.bincount(pairs[:, 0], minlength=waypoints), out=start[1:])
    return start, np.ascontiguousarray(pairs[:, 1])


def edge_sources(layout: Layout) -> NDArray[np.int32]:
    """Return the tail of each directed edge, aligned with `edge_target`, shape (M,)."""
    degrees = np.diff(layout.edge_start)
    return np.repeat(np.arange(layout.waypoints, dtype=np.int32), degrees)


def adjacency(layout: Layout, allowed: NDArray[np.bool_], *, lifts: bool = True) -> csr_array:
    """Return the graph of the edges whose both ends are allowed.

    Parameters
    ----------
    allowed
        Waypoints that may be used, shape (N,).
    lifts
        Whether riding an elevator counts as an edge.
    """
    tails, heads = edge_sources(layout), layout.edge_target
    if lifts:
        rides = [pair for elevator in layout.elevators for pair in elevator.travel_s]
        if rides:
            more = np.array(rides, dtype=np.int32)
            tails, heads = np.append(tails, more[:, 0]), np.append(heads, more[:, 1])
    kept = allowed[tails] & allowed[heads]
    ones = np.ones(int(kept.sum()), dtype=np.int8)
    size = layout.waypoints
    return csr_array((ones, (tails[kept], heads[kept])), shape=(size, size))
