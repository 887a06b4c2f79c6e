"""The edges of the waypoint graph as compressed sparse rows (CSR)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout


def compressed(
    waypoints: int, edges: Iterable[tuple[int, int]]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return directed edges, without duplicates, as `edge_start` and `edge_target` of `Layout`."""
    pairs = np.array(sorted(set(edges)), dtype=np.int32).reshape(-1, 2)
    start = np.zeros(waypoints + 1, dtype=np.int32)
    np.cumsum(np.bincount(pairs[:, 0], minlength=waypoints), out=start[1:])
    return start, np.ascontiguousarray(pairs[:, 1])


def edge_sources(layout: Layout) -> NDArray[np.int32]:
    """Return the tail of each directed edge, in the order of `Layout.edge_target`, shape (M,)."""
    degrees = np.diff(layout.edge_start)
    return np.repeat(np.arange(layout.waypoints, dtype=np.int32), degrees)
