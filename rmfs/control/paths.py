"""Lengths of shortest paths in the waypoint graph."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout


class PathLengths:
    """Lengths of shortest paths in metres, for empty and for loaded robots.

    A loaded robot does not pass through storage locations, occupied or not. The length of an
    elevator ride is the difference in height between the two tiers.

    Parameters
    ----------
    layout
        The warehouse; its graph is built on first use.
    """

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._graphs: dict[tuple[bool, bool], Any] = {}
        self._edges: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]] | None = None

    def away(self, waypoint: int, loaded: bool) -> NDArray[np.float64]:
        """Return path lengths in m from a waypoint to all N waypoints, shape (N,); inf: no path.

        The path of a loaded robot may start and end at a storage location.
        """
        return self._lengths(waypoint, loaded, backwards=False)

    def to(self, waypoint: int, loaded: bool) -> NDArray[np.float64]:
        """Return path lengths in m from all N waypoints to one, shape (N,); inf: no path."""
        return self._lengths(waypoint, loaded, backwards=True)

    def _lengths(self, waypoint: int, loaded: bool, *, backwards: bool) -> NDArray[np.float64]:
        graph = self._graph(loaded, backwards)
        if not (loaded and self._layout.is_storage[waypoint]):
            return self._dijkstra(graph, waypoint)
        # no edge leaves a storage location in this graph, so the first step is taken separately
        tails, heads, metres = self._all_edges()
        if backwards:
            tails, heads = heads, tails
        steps = tails == waypoint
        lengths = np.full(self._layout.waypoints, np.inf)
        for head, first in zip(heads[steps].tolist(), metres[steps].tolist(), strict=True):
            np.minimum(lengths, first + self._dijkstra(graph, head), out=lengths)
        lengths[waypoint] = 0.0
        return lengths

    @staticmethod
    def _dijkstra(graph: Any, waypoint: int) -> NDArray[np.float64]:
        # loading this part of SciPy takes longer than a short run of rules that do not need it
        from scipy.sparse.csgraph import dijkstra

        lengths: NDArray[np.float64] = dijkstra(graph, indices=np.array([waypoint]))[0]
        return lengths

    def _graph(self, loaded: bool, backwards: bool) -> Any:
        """Build the graph, without the edges that leave storage locations if robots are loaded."""
        from scipy.sparse import csr_array

        key = (loaded, backwards)
        if key not in self._graphs:
            tails, heads, metres = self._all_edges()
            if backwards:
                tails, heads = heads, tails
            if loaded:
                kept = ~self._layout.is_storage[tails]
                tails, heads, metres = tails[kept], heads[kept], metres[kept]
            count = self._layout.waypoints
            self._graphs[key] = csr_array((metres, (tails, heads)), shape=(count, count))
        return self._graphs[key]

    def _all_edges(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """Tails, heads and lengths of all edges, rides in elevators included, (M,) each."""
        if self._edges is None:
            plan = self._layout
            tails = np.repeat(np.arange(plan.waypoints), np.diff(plan.edge_start))
            heads = plan.edge_target.astype(np.int64)
            x, y = plan.x_m[heads] - plan.x_m[tails], plan.y_m[heads] - plan.y_m[tails]
            rides = [ride for elevator in plan.elevators for ride in elevator.travel_s]
            heights = [self._tiers_apart_m(*ride) for ride in rides]
            self._edges = (
                np.concatenate([tails, np.array([a for a, _ in rides], np.int64)]),
                np.concatenate([heads, np.array([b for _, b in rides], np.int64)]),
                np.concatenate([np.sqrt(x * x + y * y), np.array(heights, np.float64)]),
            )
        return self._edges

    def _tiers_apart_m(self, one: int, other: int) -> float:
        tiers, tier = self._layout.tiers, self._layout.tier
        return abs(tiers[int(tier[one])].height_m - tiers[int(tier[other])].height_m)
