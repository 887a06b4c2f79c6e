"""Many warehouses beside each other as one: more than one would wait for a planner to move."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.view.container import pack, unpack

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.view.scene import Arrays

GAP_M = 2.0

EACH = {
    "pod_waypoint": "waypoint",
    "pod_capacity": "",
    "robot_waypoint": "waypoint",
    "robot_heading_rad": "",
    "robot_kind": "",
    "tier": "",
    "is_storage": "",
    "is_queue": "",
    "edge_target": "waypoint",
    "motion.end_us": "",
    "motion.t0_us": "",
    "motion.kind": "",
    "motion.from_wp": "waypoint",
    "motion.to_wp": "waypoint",
    "motion.heading0_rad": "",
    "motion.heading1_rad": "",
    "motion.pod": "pod",
    "motion.top_speed_m_s": "",
}
"""Arrays that every copy adds to, and what their numbers name."""

EVENTS = {
    "time_us": "",
    "kind": "",
    "robot": "robot",
    "pod": "pod",
    "station": "station",
    "order": "order",
    "sku": "",
    "units": "",
    "detail": "",
}


def copies(scene: bytes, side: int) -> bytes:
    """Return a scene with `side` times `side` copies of a run's warehouse on one floor.

    Robots, pods, stations and waypoints of the second copy are numbered after those of the first,
    and so on; all copies do the same at the same time.
    """
    header, one = unpack(scene)
    number = side * side
    counts = {
        "waypoint": len(one["x_m"]),
        "robot": len(one["robot_waypoint"]),
        "pod": len(one["pod_waypoint"]),
        "station": len(header["stations"]),
        "order": int(one["events.order"].max(initial=-1)) + 1,
    }

    def all_of(name: str, what: str) -> NDArray[Any]:
        step = counts.get(what, 0)
        shifted = [np.where(one[name] < 0, one[name], one[name] + k * step) for k in range(number)]
        return np.concatenate(shifted).astype(one[name].dtype)

    many: Arrays = {name: all_of(name, what) for name, what in EACH.items()}
    order = np.argsort(np.tile(one["events.time_us"], number), kind="stable")
    many |= {
        f"events.{name}": all_of(f"events.{name}", what)[order] for name, what in EVENTS.items()
    }
    many["sku_space"] = one["sku_space"]
    for name in ("edge_start", "motion.robot_start"):
        many[name] = _starts(one[name], number)
    length_m, width_m = (
        max(tier[key] for tier in header["tiers"]) + GAP_M for key in ("length_m", "width_m")
    )
    column, row = np.divmod(np.repeat(np.arange(number), counts["waypoint"]), side)
    many["x_m"] = np.tile(one["x_m"], number) + column * length_m
    many["y_m"] = np.tile(one["y_m"], number) + row * width_m
    header["tiers"] = [
        tier | {"length_m": side * length_m - GAP_M, "width_m": side * width_m - GAP_M}
        for tier in header["tiers"]
    ]
    header["stations"] = [
        _shifted(station, k * counts["waypoint"])
        for k in range(number)
        for station in header["stations"]
    ]
    header["elevators"] = [
        [waypoint + k * counts["waypoint"] for waypoint in elevator]
        for k in range(number)
        for elevator in header["elevators"]
    ]
    return pack(header, many)


def _starts(one: NDArray[np.int32], number: int) -> NDArray[np.int32]:
    """Return where rows begin, for so many copies behind each other."""
    firsts = [one[:-1] + k * one[-1] for k in range(number)]
    return np.concatenate([*firsts, [number * one[-1]]]).astype(np.int32)


def _shifted(station: dict[str, Any], by: int) -> dict[str, Any]:
    queue = [waypoint + by for waypoint in station["queue"]]
    return station | {"waypoint": station["waypoint"] + by, "queue": queue}
