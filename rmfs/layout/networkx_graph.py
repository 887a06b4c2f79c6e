"""Layouts as networkx graphs, and graph measures computed with networkx."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import networkx as nx  # type: ignore[import-untyped]

    from rmfs.layout.model import Layout


def to_networkx(layout: Layout) -> nx.DiGraph[int]:
    """Return the waypoints and edges of a layout as a directed graph.

    Nodes are waypoint indices with the attributes `x_m`, `y_m`, `tier`, `storage`, `queue` and
    `station` (index into `Layout.stations`, or -1). Edges have the attribute `length_m`. Elevator
    rides are edges, too; they have the attributes `elevator` (index) and `travel_s` instead.
    """
    import networkx as nx

    graph: nx.DiGraph[int] = nx.DiGraph(name=layout.name)
    station = {one.waypoint: number for number, one in enumerate(layout.stations)}
    for waypoint in range(layout.waypoints):
        graph.add_node(
            waypoint,
            x_m=float(layout.x_m[waypoint]),
            y_m=float(layout.y_m[waypoint]),
            tier=int(layout.tier[waypoint]),
            storage=bool(layout.is_storage[waypoint]),
            queue=bool(layout.is_queue[waypoint]),
            station=station.get(waypoint, -1),
        )
    origin = np.repeat(np.arange(layout.waypoints), np.diff(layout.edge_start))
    target = np.asarray(layout.edge_target, np.int64)
    length = np.hypot(
        layout.x_m[target] - layout.x_m[origin], layout.y_m[target] - layout.y_m[origin]
    )
    for a, b, metres in zip(origin.tolist(), target.tolist(), length.tolist(), strict=True):
        graph.add_edge(a, b, length_m=metres)
    for number, elevator in enumerate(layout.elevators):
        for (a, b), seconds in elevator.travel_s.items():
            graph.add_edge(a, b, elevator=number, travel_s=float(seconds))
    return graph


@dataclass(frozen=True, slots=True)
class GraphMeasures:
    """Measures of the graph of a layout.

    Attributes
    ----------
    to_station_mean_m, to_station_max_m
        Mean and maximum length in m of the shortest path from a storage location to the nearest
        pick station, over the storage locations that have such a path; None if there are no such
        locations. Paths may lead through any waypoint; elevator rides count as 0 m.
    bottlenecks
        Number of articulation points of the undirected graph without queue zones, that is, of
        waypoints whose removal would disconnect other waypoints.
    """

    to_station_mean_m: float | None
    to_station_max_m: float | None
    bottlenecks: int


def measures(layout: Layout) -> GraphMeasures:
    """Compute the graph measures of a layout."""
    import networkx as nx

    graph = to_networkx(layout)
    picks = {station.waypoint for station in layout.pick_stations}
    ways: dict[int, float] = {}
    if picks:
        ways = nx.multi_source_dijkstra_path_length(graph.reverse(), picks, weight=_metres)
    far = [ways[place] for place in np.flatnonzero(layout.is_storage).tolist() if place in ways]
    queue = np.flatnonzero(layout.is_queue).tolist()
    aisles = graph.to_undirected(as_view=False)
    aisles.remove_nodes_from(queue)
    return GraphMeasures(
        float(np.mean(far)) if far else None,
        float(np.max(far)) if far else None,
        sum(1 for _ in nx.articulation_points(aisles)),
    )


def _metres(_a: int, _b: int, edge: dict[str, Any]) -> float:
    return float(edge.get("length_m", 0.0))
