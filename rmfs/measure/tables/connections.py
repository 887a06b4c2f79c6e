"""The tables `connections` (trips by start and end) and `edges` (how often each edge was used)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.columns import FLAG, INTEGER, REAL, TEXT, Column
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.measure.tables.logs import Logs


CONNECTIONS = (
    Column("from_waypoint", INTEGER, "", "Waypoint at which the trips start"),
    Column("to_waypoint", INTEGER, "", "Waypoint at which the trips end"),
    Column(
        "from_kind",
        TEXT,
        "",
        "Kind of the waypoint from_waypoint: pick, replenishment, storage, elevator, queue or road",
    ),
    Column("to_kind", TEXT, "", "Kind of the waypoint to_waypoint, with the same values"),
    Column(
        "trips", INTEGER, "trips", "Number of trips between the two waypoints, in this direction"
    ),
    Column("time_mean_s", REAL, "s", "Mean trip time"),
    Column("time_variance_s2", REAL, "s²", "Population variance of the trip time"),
    Column("time_min_s", REAL, "s", "Shortest trip time"),
    Column("time_max_s", REAL, "s", "Longest trip time"),
    Column("distance_mean_m", REAL, "m", "Mean distance driven"),
)

EDGES = (
    Column("from_waypoint", INTEGER, "", "Waypoint at which the edge starts"),
    Column("to_waypoint", INTEGER, "", "Waypoint at which the edge ends"),
    Column("ride", FLAG, "", "Whether the edge is an elevator ride to another tier"),
    Column("passages", INTEGER, "passages", "Number of times that a robot used the edge"),
    Column(
        "loaded_passages",
        INTEGER,
        "passages",
        "Number of times that a robot with a pod used the edge",
    ),
)


def connections(logs: Logs) -> pd.DataFrame:
    """Return one row per origin-destination pair of the trips that ended in the measured time."""
    told = logs.recorder.trips
    number = logs.layout.waypoints
    pair = told["from_wp"].astype(np.int64) * number + told["to_wp"]
    pairs, which = np.unique(pair, return_inverse=True)
    time = (told["t1_us"] - told["t0_us"]) / 1e6
    trips = np.bincount(which, minlength=len(pairs))
    mean = np.bincount(which, weights=time, minlength=len(pairs)) / trips
    square = np.bincount(which, weights=(time - mean[which]) ** 2, minlength=len(pairs))
    distance = np.bincount(which, weights=told["distance_m"], minlength=len(pairs))
    least, most = np.full(len(pairs), np.inf), np.full(len(pairs), -np.inf)
    np.minimum.at(least, which, time)
    np.maximum.at(most, which, time)
    start, end = pairs // number, pairs % number
    kinds = waypoint_kinds(logs.layout)
    return tidy(
        "connections",
        CONNECTIONS,
        {
            "from_waypoint": start,
            "to_waypoint": end,
            "from_kind": kinds[start],
            "to_kind": kinds[end],
            "trips": trips,
            "time_mean_s": mean,
            "time_variance_s2": square / trips,
            "time_min_s": least,
            "time_max_s": most,
            "distance_mean_m": distance / trips,
        },
    )


def edges(logs: Logs) -> pd.DataFrame:
    """Return one row per edge used in the measured time; elevator rides count as edges."""
    told, tier = logs.recorder.edges, logs.layout.tier
    return tidy(
        "edges",
        EDGES,
        {
            "from_waypoint": told["from_wp"],
            "to_waypoint": told["to_wp"],
            "ride": tier[told["from_wp"]] != tier[told["to_wp"]],
            "passages": told["passages"],
            "loaded_passages": told["loaded_passages"],
        },
    )


def waypoint_kinds(layout: Layout) -> NDArray[np.str_]:
    """Return the kind of each waypoint, as in the column `from_kind`, shape (waypoints,)."""
    kinds = np.full(layout.waypoints, "road", dtype="<U13")
    kinds[layout.is_queue] = "queue"
    kinds[layout.is_storage] = "storage"
    for name, places in (
        ("elevator", [one for elevator in layout.elevators for one in elevator.waypoints]),
        ("pick", [station.waypoint for station in layout.pick_stations]),
        ("replenishment", [station.waypoint for station in layout.replenishment_stations]),
    ):
        kinds[places] = name
    return kinds
