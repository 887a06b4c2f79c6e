"""Import of RAWSim-O's explicit instances (.xinst).

The elements are converted to the table of an explicit layout, which is then validated like the
contents of a layout file of rmfs. Ids are replaced by indices, in the order of the file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout.explicit import build
from rmfs.layout.explicit.schema import FORMAT
from rmfs.rawsimo.layout import bodies, stations, waypoints
from rmfs.rawsimo.layout.instance import Instance
from rmfs.rawsimo.xml import read_root

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.config import Table
    from rmfs.layout.model import Layout


def read_xinst(path: Path) -> tuple[Layout, list[str]]:
    """Read a file; return the layout, and remarks on what was left out or filled in.

    Raises
    ------
    InputError
        If the file cannot be read or does not describe a layout; the message names the errors.
    """
    instance = Instance(read_root(path, "Instance"))
    instance.problems.stop(path)
    table = _table(instance)
    instance.problems.stop(path)
    return build(table, str(path)), instance.remarks


def _table(instance: Instance) -> Table:
    """Return the table of the explicit layout."""
    found, occupants = waypoints.waypoints(instance)
    elevators, rides = stations.elevators(instance)
    waypoints.add_edges(instance, found, rides)
    pods, pod_radius_m = bodies.pods(instance, found, occupants)
    kinds, robots = bodies.robots(instance, found)
    return {
        "format": FORMAT,
        "name": instance.name,
        "tiers": waypoints.tiers(instance),
        "pod_radius_m": pod_radius_m,
        "robot_kinds": kinds,
        "pick_stations": stations.pick_stations(instance, occupants),
        "replenishment_stations": stations.replenishment_stations(instance, occupants),
        "elevators": elevators,
        "robots": robots,
        "pods": pods,
        "waypoints": found,
    }
