"""Pods and robots of RAWSim-O's explicit instances (.xinst)."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import KDTree

if TYPE_CHECKING:
    from rmfs.config import Table
    from rmfs.rawsimo.layout.instance import Instance
    from rmfs.rawsimo.layout.waypoints import Occupants

_ROBOT_KIND = {
    "Radius": "radius_m",
    "MaxAcceleration": "acceleration_m_s2",
    "MaxDeceleration": "deceleration_m_s2",
    "MaxVelocity": "top_speed_m_s",
    "TurnSpeed": "full_turn_s",
    "PodTransferTime": "pod_transfer_s",
}
_POD_RADIUS_M = 0.45
"""Radius assumed for pods if the file contains none (RAWSim-O's default)."""


def pods(
    instance: Instance, waypoints: list[Table], occupants: Occupants
) -> tuple[list[Table], float]:
    """Return the pods, and the largest pod radius in m.

    A pod is put at the waypoint that names the pod. If no waypoint does, it is put at the nearest
    storage location on its tier. If the file contains no pods, the radius is RAWSim-O's default.
    """
    nearest = _Nearest(waypoints, [bool(waypoint["storage"]) for waypoint in waypoints])
    radii: Counter[float] = Counter()
    found, searched = [], 0
    for position, fields in enumerate(instance.fields("Pod")):
        radii[fields.number("Radius")] += 1
        waypoint = occupants.get(("Pod", position))
        if waypoint is None:
            searched += 1
            tier = instance.position("Tier", fields.whole("Tier"), fields.label)
            waypoint = nearest.to(fields.number("X"), fields.number("Y"), tier)
            if waypoint is None:
                instance.problems.add(f"{fields.label}: there is no storage location on its tier")
        found.append({"waypoint": waypoint or 0, "capacity": fields.number("Capacity")})
    if searched:
        instance.remarks.append(
            f"{searched} pods are named by no waypoint and were put at the nearest storage location"
        )
    if len(radii) > 1:
        instance.remarks.append(
            f"pods have {len(radii)} different radii: the largest is used for all"
        )
    return found, max(radii, default=_POD_RADIUS_M)


def robots(instance: Instance, waypoints: list[Table]) -> tuple[list[Table], list[Table]]:
    """Return the kinds of robots, and the robots.

    Robots with the same parameters (top speed and so on) form a kind. Each robot is put at the
    nearest waypoint on its tier.
    """
    nearest = _Nearest(waypoints, [True] * len(waypoints))
    kinds: dict[tuple[float, ...], int] = {}
    found: list[Table] = []
    for fields in instance.fields("Bot"):
        kind = tuple(fields.number(name) for name in _ROBOT_KIND)
        tier = instance.position("Tier", fields.whole("Tier"), fields.label)
        waypoint = nearest.to(fields.number("X"), fields.number("Y"), tier)
        if waypoint is None:
            instance.problems.add(f"{fields.label}: there is no waypoint on its tier")
        found.append(
            {
                "waypoint": waypoint or 0,
                "heading_rad": fields.number("Orientation", 0.0),
                "kind": kinds.setdefault(kind, len(kinds)),
            }
        )
    if not kinds:
        instance.problems.add("Bots: at least one robot is needed")
    names = _ROBOT_KIND.values()
    return [dict(zip(names, kind, strict=True)) for kind in kinds], found


class _Nearest:
    """Finds the nearest of the eligible waypoints on a tier."""

    def __init__(self, waypoints: list[Table], eligible: list[bool]) -> None:
        members: dict[int, list[int]] = {}
        for v, waypoint in enumerate(waypoints):
            if eligible[v]:
                members.setdefault(waypoint["tier"], []).append(v)
        self._trees: dict[int, tuple[KDTree, list[int]]] = {}
        for tier, found in members.items():
            places = [(waypoints[v]["x_m"], waypoints[v]["y_m"]) for v in found]
            self._trees[tier] = KDTree(np.array(places)), found

    def to(self, x_m: float, y_m: float, tier: int) -> int | None:
        """Return the nearest waypoint, or None if the tier has none."""
        if tier not in self._trees:
            return None
        tree, found = self._trees[tier]
        return found[int(tree.query((x_m, y_m))[1])]
