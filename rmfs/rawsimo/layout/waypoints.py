"""Tiers, waypoints and edges of RAWSim-O's explicit instances (.xinst)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.layout.fields import NOBODY, Fields

if TYPE_CHECKING:
    from rmfs.config import Table
    from rmfs.rawsimo.layout.instance import Instance

Occupants = dict[tuple[str, int], int]
"""Index of the waypoint that names a pod or station, by kind and index of the pod or station."""


def tiers(instance: Instance) -> list[Table]:
    """Return the tiers."""
    return [
        {
            "length_m": fields.number("Length"),
            "width_m": fields.number("Width"),
            "height_m": fields.number("RelativePositionZ", 0.0),
        }
        for fields in instance.fields("Tier")
    ]


def waypoints(instance: Instance) -> tuple[list[Table], Occupants]:
    """Return the waypoints, without edges, and for each pod or station the waypoint that names it.

    As in RAWSim-O, a waypoint that names a pod or station gets the coordinates of that pod or
    station, and a waypoint that names a pod is a storage location.
    """
    found: list[Table] = []
    occupants: Occupants = {}
    moved = 0
    for fields in instance.fields("Waypoint"):
        x_m, y_m = fields.number("X"), fields.number("Y")
        for kind in ("Pod", "InputStation", "OutputStation"):
            body = _occupant(instance, fields, kind, len(found), occupants)
            if body is not None:
                at_m = body.number("X", x_m), body.number("Y", y_m)
                moved += at_m != (x_m, y_m)
                x_m, y_m = at_m
        holds_pod = fields.whole("Pod", NOBODY) != NOBODY
        found.append(
            {
                "x_m": x_m,
                "y_m": y_m,
                "tier": instance.position("Tier", fields.whole("Tier"), fields.label),
                "storage": fields.switch("PodStorageLocation") or holds_pod,
                "queue": fields.switch("IsQueueWaypoint"),
            }
        )
    if moved:
        instance.remarks.append(f"{moved} waypoints moved to the pod or station they name")
    return found, occupants


def _occupant(
    instance: Instance, fields: Fields, kind: str, waypoint: int, occupants: Occupants
) -> Fields | None:
    """Return the pod or station that a waypoint names, and add it to `occupants`."""
    name = fields.whole(kind, NOBODY)
    if name == NOBODY:
        return None
    position = instance.position(kind, name, fields.label)
    if not instance.has(kind, name):
        return None
    if (kind, position) in occupants:
        instance.problems.add(f"{kind} {name}: named by two waypoints")
    occupants[kind, position] = waypoint
    return Fields(instance.elements(kind)[position], instance.problems)


def add_edges(instance: Instance, waypoints: list[Table], rides: set[tuple[int, int]]) -> None:
    """Add the edges within tiers.

    Edges between tiers are left out, because the rides of elevators replace them. A remark gives
    the number of such edges that belong to no elevator.

    Parameters
    ----------
    waypoints
        The waypoints, as returned by the function `waypoints`. The edges from a waypoint are added
        to it, as the value of the key `to`.
    rides
        Rides of elevators as pairs (origin, destination) of waypoints.
    """
    across = 0
    for v, element in enumerate(instance.elements("Waypoint")):
        heads: list[int] = []
        for path in element.iterfind("Paths/Waypoint"):
            head = instance.waypoint(path.text, f"Waypoint {element.get('ID')}")
            if waypoints[head]["tier"] == waypoints[v]["tier"]:
                heads.append(head)
            else:
                across += (v, head) not in rides
        waypoints[v]["to"] = heads
    if across:
        instance.remarks.append(
            f"{across} edges between tiers left out: they belong to no elevator"
        )
