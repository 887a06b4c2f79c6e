"""Layouts as graphs of networkx, and the measures that `rmfs layout check` prints."""

import networkx as nx
import numpy as np
import pytest

from rmfs.cli import main
from rmfs.layout import load
from rmfs.layout.networkx_graph import measures


def test_waypoints_and_edges_become_a_graph():
    layout = load("study-tiers")
    graph = layout.to_networkx()
    rides = [edge for edge in graph.edges(data=True) if "travel_s" in edge[2]]
    assert graph.number_of_nodes() == layout.waypoints
    assert graph.number_of_edges() == len(layout.edge_target) + len(rides)
    assert len(rides) == sum(len(elevator.travel_s) for elevator in layout.elevators) > 0
    assert nx.is_strongly_connected(graph)
    assert sum(graph.nodes[place]["storage"] for place in graph) == layout.is_storage.sum()
    for number, station in enumerate(layout.stations):
        assert graph.nodes[station.waypoint]["station"] == number
    a = 7
    for b in layout.edge_target[layout.edge_start[a] : layout.edge_start[a + 1]]:
        away = np.hypot(layout.x_m[a] - layout.x_m[b], layout.y_m[a] - layout.y_m[b])
        assert graph.edges[a, int(b)]["length_m"] == pytest.approx(away)


def test_measures_are_those_of_shortest_ways():
    layout = load("small")
    graph = layout.to_networkx()
    ways = dict(nx.all_pairs_dijkstra_path_length(graph, weight="length_m"))
    picks = [station.waypoint for station in layout.pick_stations]
    near = [min(ways[place][pick] for pick in picks) for place in layout.is_storage.nonzero()[0]]
    found = measures(layout)
    assert found.to_station_mean_m == pytest.approx(np.mean(near))
    assert found.to_station_max_m == pytest.approx(max(near))


def test_a_place_that_all_must_pass_is_counted(tmp_path):
    """Two rooms, and one cell between them."""
    path = tmp_path / "rooms.map"
    path.write_text("type octile\nheight 2\nwidth 5\nmap\n..@..\n.....\n")
    found = measures(load(path))
    assert found.bottlenecks == 3  # the cell, and its neighbours
    assert found.to_station_mean_m is None


def test_check_prints_them(capsys):
    assert main(["layout", "check", "small"]) == 0
    told = capsys.readouterr().out
    assert "distance from a storage location to the nearest pick station: " in told
    assert "waypoints whose closure would disconnect the floor: " in told
