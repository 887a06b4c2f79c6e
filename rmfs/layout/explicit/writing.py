"""Writes explicit layouts."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from rmfs.files import write_text
from rmfs.layout.explicit.schema import FORMAT
from rmfs.layout.kinds import described

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rmfs.config import Table
    from rmfs.layout.model import (
        Layout,
        PickStation,
        ReplenishmentStation,
        RobotKind,
        Tier,
    )


def save_json(layout: Layout, path: Path) -> None:
    """Write a layout as an explicit layout file, completely or not at all.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    write_text(path, _dumps(_table(layout)))


def _table(layout: Layout) -> Table:
    """Return the contents of the file for a layout; default values are left out."""
    return {
        "format": FORMAT,
        "name": layout.name,
        "tiers": [_fields(tier) for tier in layout.tiers],
        "pod_radius_m": float(layout.pod_radius_m),
        "robot_kinds": [_fields(kind) for kind in layout.robot_kinds],
        "pick_stations": [_station(station) for station in layout.pick_stations],
        "replenishment_stations": [_station(station) for station in layout.replenishment_stations],
        **({"other_stations": _others(layout)} if layout.other_stations else {}),
        "elevators": [
            {
                "queues": [list(elevator.queues[waypoint]) for waypoint in elevator.waypoints],
                "rides": [
                    {"origin": origin, "destination": destination, "travel_s": travel_s}
                    for (origin, destination), travel_s in elevator.travel_s.items()
                ],
            }
            for elevator in layout.elevators
        ],
        "robots": [
            {"waypoint": waypoint, "heading_rad": heading_rad, "kind": kind}
            for waypoint, heading_rad, kind in zip(
                layout.robot_waypoint.tolist(),
                layout.robot_heading_rad.tolist(),
                layout.robot_kind.tolist(),
                strict=True,
            )
        ],
        "pods": [
            {"waypoint": waypoint, "capacity": capacity}
            for waypoint, capacity in zip(
                layout.pod_waypoint.tolist(), layout.pod_capacity.tolist(), strict=True
            )
        ],
        "waypoints": list(_waypoints(layout)),
    }


def _others(layout: Layout) -> Table:
    return {
        kind.name: {
            **described(kind),
            "stations": [
                {"queue": list(station.queue), "radius_m": station.radius_m}
                for station in layout.other_stations
                if station.kind.name == kind.name
            ],
        }
        for kind in layout.other_kinds
    }


def _waypoints(layout: Layout) -> Iterator[Table]:
    start, target = layout.edge_start.tolist(), layout.edge_target.tolist()
    for v in range(layout.waypoints):
        entry: Table = {"x_m": float(layout.x_m[v]), "y_m": float(layout.y_m[v])}
        entry["tier"] = int(layout.tier[v])
        entry["to"] = target[start[v] : start[v + 1]]
        if layout.is_storage[v]:
            entry["storage"] = True
        if layout.is_queue[v]:
            entry["queue"] = True
        yield entry


def _fields(thing: Tier | RobotKind | PickStation | ReplenishmentStation) -> Table:
    return {name: getattr(thing, name) for name in type(thing).__slots__}


def _station(station: PickStation | ReplenishmentStation) -> Table:
    fields = _fields(station)
    del fields["waypoint"]  # the first place of the queue
    return {**fields, "queue": list(station.queue)}


def _dumps(table: Table) -> str:
    """Write a table with one entry of each list per line."""
    parts = []
    for key, value in table.items():
        if isinstance(value, list) and value:
            entries = ",\n".join(f"    {json.dumps(entry)}" for entry in value)
            parts.append(f'  "{key}": [\n{entries}\n  ]')
        else:
            parts.append(f'  "{key}": {json.dumps(value)}')
    return "{\n" + ",\n".join(parts) + "\n}\n"
