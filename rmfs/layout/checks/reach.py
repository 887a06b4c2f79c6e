"""Reachability between waypoints if only some of the waypoints may be used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Mask = NDArray[np.bool_]


class Reach:
    """Reachability over edges and elevator rides between allowed waypoints.

    Sets of waypoints are Boolean arrays of shape (N,), where N is the number of waypoints.

    Parameters
    ----------
    allowed
        Waypoints that may be used.
    """

    def __init__(self, layout: Layout, allowed: Mask) -> None:
        self._graph: csr_array = _adjacency(layout, allowed)
        self._back: csr_array = self._graph.T.tocsr()
        self.allowed = allowed

    def forward(self, sources: Mask) -> Mask:
        """Return the waypoints reachable from allowed sources, including these sources."""
        return _search(self._graph, sources & self.allowed)

    def backward(self, goals: Mask) -> Mask:
        """Return the waypoints from which allowed goals are reachable, including these goals."""
        return _search(self._back, goals & self.allowed)

    def components(self) -> NDArray[np.int32]:
        """Return the index of the strongly connected component of each waypoint, shape (N,)."""
        labels: NDArray[np.int32] = connected_components(
            self._graph, directed=True, connection="strong"
        )[1]
        return labels

    def largest(self, counted: Mask) -> Mask:
        """Return the strongly connected component with the most allowed waypoints of `counted`.

        Returns
        -------
        The waypoints of this component; none if no waypoint of `counted` is allowed.
        """
        labels = self.components()
        counted = counted & self.allowed
        if not counted.any():
            return np.zeros_like(counted)
        best = np.bincount(labels[counted]).argmax()
        return np.asarray((labels == best) & self.allowed)


def entered_from(layout: Layout, tails: NDArray[np.int32], sources: Mask) -> Mask:
    """Return the waypoints to which an edge leads from one of the sources."""
    found = np.zeros(layout.waypoints, dtype=np.bool_)
    found[layout.edge_target[sources[tails]]] = True
    return found


def leading_to(layout: Layout, tails: NDArray[np.int32], goals: Mask) -> Mask:
    """Return the waypoints from which an edge leads to one of the goals."""
    found = np.zeros(layout.waypoints, dtype=np.bool_)
    found[tails[goals[layout.edge_target]]] = True
    return found


def _adjacency(layout: Layout, allowed: Mask) -> csr_array:
    """Return the graph of the edges and elevator rides with two allowed ends."""
    tails, heads = edge_sources(layout), layout.edge_target
    rides = [pair for elevator in layout.elevators for pair in elevator.travel_s]
    if rides:
        more = np.array(rides, dtype=np.int32)
        tails, heads = np.append(tails, more[:, 0]), np.append(heads, more[:, 1])
    kept = allowed[tails] & allowed[heads]
    ones = np.ones(int(kept.sum()), dtype=np.int8)
    size = layout.waypoints
    return csr_array((ones, (tails[kept], heads[kept])), shape=(size, size))


def _search(graph: csr_array, sources: Mask) -> Mask:
    """Breadth-first search from many sources: repeated from the first source not yet reached."""
    reached = np.zeros_like(sources)
    while (open_sources := np.flatnonzero(sources & ~reached)).size:
        order = breadth_first_order(graph, open_sources[0], return_predecessors=False)
        reached[order] = True
    return reached
