"""Checks that robots and pods do not touch if robots reserve the waypoints of the edges they use.

A robot on an edge reserves both ends of the edge. Reservations therefore keep two robots apart if
there is a minimum distance between any two waypoints, between any two edges without a common end,
and between any edge and any waypoint that is not one of its ends (docs/safety.md). This distance is
twice the largest radius of a robot or pod. Pods are treated as discs. Their radius counts on all
edges, since a pod can be carried along any of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import KDTree

from rmfs.layout.checks.violation import IMPOSSIBLE, Violation, grouped, waypoint_label
from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Points = NDArray[np.float64]
    Pairs = NDArray[np.int64]

TOLERANCE_M = 1e-9
LONG = 3.0
"""Edges longer than this multiple of the median length are compared with all others one by one."""

GRID_TOLERANCE = 1e-6
"""Share of the spacing of a regular grid by which the spacing must exceed the required distance.
Positions may be off the grid by an eighth of this share of the spacing."""


def separation(layout: Layout) -> Iterator[Violation]:
    """Yield violations: waypoints or edges nearer to each other than twice the largest radius.

    Edges are checked only if no two waypoints are too near to each other. Edges with a common end
    are not compared.
    """
    radii = [kind.radius_m for kind in layout.robot_kinds]
    if layout.pods:
        radii.append(layout.pod_radius_m)
    needed_m = 2 * max(radii)
    points = _points(layout, needed_m)
    near, distance_m = _near_waypoints(points, needed_m)
    if near.size:
        labels = [_pair(layout, int(a), int(b)) for a, b in near]
        yield from _report(labels, distance_m, needed_m)
        return  # close waypoints make every edge between them close too
    edges = _undirected(layout)
    if _is_wide_grid(layout, edges, needed_m):
        return
    yield from _beside_edges(layout, points, edges, needed_m)
    yield from _close_edges(points, edges, needed_m)


def _points(layout: Layout, needed_m: float) -> Points:
    """Return positions in the plane, shape (N, 2), with the tiers laid out far from each other."""
    reach_m = float(np.ptp(layout.y_m)) + 10 * needed_m
    return np.column_stack([layout.x_m, layout.y_m + layout.tier * reach_m])


def _near_waypoints(points: Points, needed_m: float) -> tuple[Pairs, Points]:
    """Return each waypoint too close to its nearest neighbour, that neighbour, and the distance."""
    if len(points) < 2:
        return np.empty((0, 2), dtype=np.int64), np.empty(0)
    # the annotations of the library allow for single points
    distances_m, found = (np.asarray(part) for part in KDTree(points).query(points, k=2))
    own = np.arange(len(points))
    # of two waypoints at one place either may come first
    other = np.where(found[:, 0] == own, found[:, 1], found[:, 0])
    near = distances_m[:, 1] < needed_m - TOLERANCE_M
    pairs = np.sort(np.column_stack([own, other])[near], axis=1)
    pairs, first = np.unique(pairs, axis=0, return_index=True)
    return pairs, distances_m[near, 1][first]


def _undirected(layout: Layout) -> Pairs:
    """Return each pair of joined waypoints once, shape (U, 2)."""
    ends = np.column_stack([edge_sources(layout), layout.edge_target]).astype(np.int64)
    ends.sort(axis=1)
    return np.unique(ends, axis=0)


def _is_wide_grid(layout: Layout, edges: Pairs, needed_m: float) -> bool:
    """Whether all edges join neighbours of one square grid that is wide enough.

    Then edges without a common end, and edges and waypoints that are not their ends, are at least
    the width of the grid apart.
    """
    if not edges.size:
        return True
    tail, head = edges.T
    dx_m, dy_m = layout.x_m[head] - layout.x_m[tail], layout.y_m[head] - layout.y_m[tail]
    width_m = float(max(abs(dx_m[0]), abs(dy_m[0])))
    if width_m < needed_m + GRID_TOLERANCE * width_m:
        return False
    along, across = np.maximum(abs(dx_m), abs(dy_m)), np.minimum(abs(dx_m), abs(dy_m))
    offset = np.concatenate([layout.x_m - layout.x_m[0], layout.y_m - layout.y_m[0]]) / width_m
    return bool(
        (layout.tier[head] == layout.tier[tail]).all()
        and (abs(along - width_m) <= GRID_TOLERANCE * width_m / 8).all()
        and (across <= GRID_TOLERANCE * width_m / 8).all()
        and (abs(offset - np.rint(offset)) <= GRID_TOLERANCE / 8).all()
    )


def _beside_edges(
    layout: Layout, points: Points, edges: Pairs, needed_m: float
) -> Iterator[Violation]:
    """Yield waypoints too near to an edge of which they are not an end."""
    if not edges.size:
        return
    tail, head = points[edges[:, 0]], points[edges[:, 1]]
    half_m = np.hypot(*(head - tail).T) / 2
    found = KDTree(points).query_ball_point((tail + head) / 2, half_m + needed_m)
    edge = np.repeat(np.arange(len(edges)), [len(some) for some in found])
    waypoint = np.concatenate([np.asarray(some, dtype=np.int64) for some in found])
    foreign = (waypoint != edges[edge, 0]) & (waypoint != edges[edge, 1])
    edge, waypoint = edge[foreign], waypoint[foreign]
    distance_m = _point_to_segment(points[waypoint], tail[edge], head[edge])
    bad = np.flatnonzero(distance_m < needed_m - TOLERANCE_M)
    labels = [
        f"{waypoint_label(layout, int(waypoint[i]))} and edge {_edge(edges[edge[i]])}" for i in bad
    ]
    yield from _report(labels, distance_m[bad], needed_m)


def _close_edges(points: Points, edges: Pairs, needed_m: float) -> Iterator[Violation]:
    """Yield edges without a common end that come too near to each other."""
    pairs = _candidates(points, edges, needed_m)
    first, second = edges[pairs[:, 0]], edges[pairs[:, 1]]
    apart = (first[:, :, None] != second[:, None, :]).all(axis=(1, 2))
    first, second = first[apart], second[apart]
    distance_m = _segment_to_segment(
        points[first[:, 0]], points[first[:, 1]], points[second[:, 0]], points[second[:, 1]]
    )
    bad = np.flatnonzero(distance_m < needed_m - TOLERANCE_M)
    labels = [f"edges {_edge(first[i])} and {_edge(second[i])}" for i in bad]
    yield from _report(labels, distance_m[bad], needed_m)


def _candidates(points: Points, edges: Pairs, needed_m: float) -> Pairs:
    """Return pairs of edges that may be too near, by the distance of their midpoints."""
    if len(edges) < 2:
        return np.empty((0, 2), dtype=np.int64)
    middle = points[edges].mean(axis=1)
    length_m = np.hypot(*(points[edges[:, 0]] - points[edges[:, 1]]).T)
    long = length_m > LONG * np.median(length_m)
    short = np.flatnonzero(~long)
    reach_m = float(length_m[short].max()) + needed_m
    local: Pairs = KDTree(middle[short]).query_pairs(reach_m, output_type="ndarray")
    pairs = [short[local]]
    for edge in np.flatnonzero(long):
        others = np.flatnonzero(~long | (np.arange(len(edges)) > edge))
        pairs.append(np.column_stack([np.full(len(others), edge), others]))
    return np.concatenate(pairs)


def _segment_to_segment(a: Points, b: Points, c: Points, d: Points) -> Points:
    """Return the distances between the segments ab and cd, row by row."""
    ends = np.minimum.reduce(
        [
            _point_to_segment(a, c, d),
            _point_to_segment(b, c, d),
            _point_to_segment(c, a, b),
            _point_to_segment(d, a, b),
        ]
    )
    crossing = (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)
    return np.where(crossing, 0.0, ends)


def _point_to_segment(point: Points, start: Points, end: Points) -> Points:
    along = end - start
    squared = np.maximum((along**2).sum(axis=1), TOLERANCE_M**2)
    share = np.clip(((point - start) * along).sum(axis=1) / squared, 0.0, 1.0)
    distances: Points = np.hypot(*(point - start - share[:, None] * along).T)
    return distances


def _side(a: Points, b: Points, c: Points) -> Points:
    """Return on which side of the line ab the points c lie: positive, negative or 0."""
    return (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])


def _pair(layout: Layout, a: int, b: int) -> str:
    return f"{waypoint_label(layout, a)} and {waypoint_label(layout, b)}"


def _edge(ends: NDArray[np.int64]) -> str:
    return f"{ends[0]}-{ends[1]}"


def _report(labels: list[str], distances_m: Points, needed_m: float) -> Iterator[Violation]:
    if labels:
        message = (
            f"{float(distances_m.min()):.3g} m apart at the nearest, less than the sum of the "
            "two radii "
            f"that pass there ({needed_m:g} m)"
        )
        yield from grouped(IMPOSSIBLE, labels, message)
