"""The reference system's layout files, and what they contain, read without our importer."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import pytest

INSTANCES = Path(__file__).resolve().parents[2] / "../shared/reference/instances"

needs_reference = pytest.mark.skipif(
    not INSTANCES.is_dir(), reason="the reference instances are not on this machine"
)

Place = tuple[int, float, float]
"""(tier, x, y)"""


@dataclass(frozen=True)
class ReferenceLayout:
    """A layout by coordinates, so that numbering plays no part."""

    places: set[Place]
    edges: set[tuple[Place, Place]]
    storage: set[Place]
    queue: set[Place]
    picks: list[tuple[tuple[Place, ...], int]]
    replenishments: list[tuple[tuple[Place, ...], int]]
    elevators: list[tuple[dict[tuple[Place, Place], float], dict[Place, tuple[Place, ...]]]]
    pods: int
    robots: int


def read_reference(name: str) -> ReferenceLayout:
    """Read an .xinst file below the instances folder."""
    root = ElementTree.parse(INSTANCES / name).getroot()
    waypoints = root.find("Waypoints")
    at = {
        w.get("ID"): (int(w.get("Tier")), float(w.get("X")), float(w.get("Y"))) for w in waypoints
    }

    def queues(element):
        found: dict[Place, list[Place]] = {}
        for entry in element.find("Queues"):
            key, place = entry.text.split("/")
            found.setdefault(at[key], []).append(at[place])
        return {key: tuple(queue) for key, queue in found.items()}

    def stations(kind):
        return [
            (next(iter(queues(s).values())), int(s.get("ActivationOrderID", "0")))
            for s in root.iter(kind)
        ]

    elevators = []
    for elevator in root.find("Elevators"):
        timings = [entry.text.split("/") for entry in elevator.find("Timings")]
        elevators.append(({(at[a], at[b]): float(s) for a, b, s in timings}, queues(elevator)))
    return ReferenceLayout(
        places=set(at.values()),
        edges={
            (at[w.get("ID")], at[path.text])
            for w in waypoints
            for path in w.find("Paths")
            if at[w.get("ID")][0] == at[path.text][0]
        },
        storage={at[w.get("ID")] for w in waypoints if w.get("PodStorageLocation") == "true"},
        queue={at[w.get("ID")] for w in waypoints if w.get("IsQueueWaypoint") == "true"},
        picks=stations("OutputStation"),
        replenishments=stations("InputStation"),
        elevators=elevators,
        pods=len(root.find("Pods")),
        robots=len(root.find("Bots")),
    )


def by_coordinates(layout) -> ReferenceLayout:
    """Return one of our layouts in the same form."""
    at = [
        (int(t), float(x), float(y))
        for t, x, y in zip(layout.tier, layout.x_m, layout.y_m, strict=True)
    ]
    edges = {
        (at[v], at[w])
        for v in range(layout.waypoints)
        for w in layout.edge_target[layout.edge_start[v] : layout.edge_start[v + 1]]
    }

    def stations(found):
        return [(tuple(at[place] for place in s.queue), s.activation) for s in found]

    return ReferenceLayout(
        places=set(at),
        edges=edges,
        storage={at[v] for v in layout.is_storage.nonzero()[0]},
        queue={at[v] for v in layout.is_queue.nonzero()[0]},
        picks=stations(layout.pick_stations),
        replenishments=stations(layout.replenishment_stations),
        elevators=[
            (
                {(at[a], at[b]): seconds for (a, b), seconds in elevator.travel_s.items()},
                {at[v]: tuple(at[p] for p in queue) for v, queue in elevator.queues.items()},
            )
            for elevator in layout.elevators
        ],
        pods=layout.pods,
        robots=layout.robots,
    )
