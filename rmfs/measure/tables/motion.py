"""The tables `trips`, `plans` and `heat`, made from the records of `rmfs.traffic`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.columns import FLAG, INTEGER, REAL, TEXT, Column
from rmfs.measure.energy import WH
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.measure.tables.logs import Logs

TRIP_KINDS = np.array(["to_pod", "to_station", "to_storage", "to_rest"])


TRIPS = (
    Column("robot", INTEGER, "", "Robot"),
    Column("kind", TEXT, "", "Kind of the trip: to_pod, to_station, to_storage or to_rest"),
    Column("from_waypoint", INTEGER, "", "Waypoint at which the trip starts"),
    Column("to_waypoint", INTEGER, "", "Waypoint at which the trip ends"),
    Column(
        "start_s",
        REAL,
        "s",
        "Time at which the robot got the command to drive or, if it was still driving, lifting a "
        "pod or out of order then, could set off",
    ),
    Column("end_s", REAL, "s", "Time of arrival; for a trip to a station, at its queue zone"),
    Column("station", INTEGER, "", "Destination station; -1 for other kinds of trips"),
    Column("loaded", FLAG, "", "Whether the robot carried a pod"),
    Column("distance_m", REAL, "m", "Distance driven; for a trip to a station, up to the station"),
    Column(
        "unhindered_s",
        REAL,
        "s",
        "Lower bound on the duration of the trip without other robots; for a trip to a "
        "station, up to its queue zone",
    ),
    Column(
        "hindered_s",
        REAL,
        "s",
        "Delay: end_s - start_s - unhindered_s. The causes are other robots and, if planning "
        "takes simulated time, planning; slightly negative for some trips to stations, since "
        "robots do not stop at the border of the queue zone",
    ),
    Column(
        "awaited_s",
        REAL,
        "s",
        "Part of hindered_s: time at the beginning of the trip in which the robot waited for "
        "its plan; 0 if planning takes no simulated time",
    ),
    Column(
        "energy_wh",
        REAL,
        "Wh",
        "Energy drawn on the trip (for a trip to a station, up to the station); empty if "
        "energy is not modelled",
    ),
)

PLANS = (
    Column("robot", INTEGER, "", "Robot"),
    Column("asked_us", INTEGER, "us", "Time at which the robot requested a plan"),
    Column("begun_us", INTEGER, "us", "Time at which a planner began the search"),
    Column("labels", INTEGER, "labels", "Labels (partial routes) expanded in the search"),
    Column("took_us", INTEGER, "us", "Simulated time that the search took"),
    Column("found", FLAG, "", "Whether the search found a route"),
    Column("wall_s", REAL, "s", "Wall time of the search", measured=True),
)

_PURPOSES = {
    "pick": "while fetching a pod for a pick station, bringing the pod to the station, or standing "
    "at the station",
    "replenish": "while fetching a pod for a replenishment station, bringing the pod to the "
    "station, or standing at the station",
    "store": "while fetching or carrying a pod for any other purpose",
    "rest": "without a pod and without a task that involves a pod",
}

HEAT = (
    Column("waypoint", INTEGER, "", "Waypoint"),
    Column("tier", INTEGER, "", "Floor"),
    Column("x_m", REAL, "m", "x coordinate"),
    Column("y_m", REAL, "m", "y coordinate"),
    Column("visits", INTEGER, "visits", "Number of times that a robot passed or stopped here"),
    Column(
        "loaded_visits",
        INTEGER,
        "visits",
        "Number of times that a robot with a pod passed or stopped here",
    ),
    *(
        Column(
            f"{task}_visits",
            INTEGER,
            "visits",
            f"Number of times that a robot passed or stopped here, {what}",
        )
        for task, what in _PURPOSES.items()
    ),
    Column("waiting_s", REAL, "s", "Time that robots stood here, excluding idle robots"),
    Column("loaded_waiting_s", REAL, "s", "Time that robots stood here with a pod"),
    *(
        Column(f"{task}_waiting_s", REAL, "s", f"Time that robots stood here, {what}")
        for task, what in _PURPOSES.items()
    ),
)


def trips(logs: Logs) -> pd.DataFrame:
    """Return one row per trip that ended in the measured time, sorted by end time."""
    told = logs.recorder.trips
    station = np.full(logs.layout.waypoints, -1)
    station[[one.waypoint for one in logs.layout.stations]] = np.arange(len(logs.layout.stations))
    to_station = TRIP_KINDS[told["kind"]] == "to_station"
    return tidy(
        "trips",
        TRIPS,
        {
            "robot": told["robot"],
            "kind": TRIP_KINDS[told["kind"]],
            "from_waypoint": told["from_wp"],
            "to_waypoint": told["to_wp"],
            "start_s": told["t0_us"] / 1e6,
            "end_s": told["t1_us"] / 1e6,
            "station": np.where(to_station, station[told["to_wp"]], -1),
            "loaded": told["loaded"],
            "distance_m": told["distance_m"],
            "unhindered_s": told["unhindered_s"],
            "hindered_s": (told["t1_us"] - told["t0_us"]) / 1e6 - told["unhindered_s"],
            "awaited_s": told["awaited_s"],
            "energy_wh": told["energy_j"] / WH if logs.recorder.energy.final else np.nan,
        },
    )


def plans(logs: Logs) -> pd.DataFrame:
    """Return one row per search for a route for a trip, including searches in the warm-up.

    The table is empty if searches take no simulated time.
    """
    told = logs.recorder.plans
    return tidy("plans", PLANS, {column.name: told[column.name] for column in PLANS})


def heat(logs: Logs) -> pd.DataFrame:
    """Return one row per waypoint: visits and waiting times of robots in the measured time."""
    layout, counted = logs.layout, logs.recorder.heat
    return tidy(
        "heat",
        HEAT,
        {
            "waypoint": np.arange(layout.waypoints),
            "tier": layout.tier,
            "x_m": layout.x_m,
            "y_m": layout.y_m,
            **{name: counted[name] for name in ("visits", "loaded_visits")},
            **{name: counted[name] for name in ("waiting_s", "loaded_waiting_s")},
            **_by_task(layout, counted, "visits"),
            **_by_task(layout, counted, "waiting_s"),
        },
    )


def _by_task(layout: Layout, counted: dict[str, NDArray[Any]], what: str) -> dict[str, Any]:
    """Return the sums of a count by kind of task: one column per kind, one value per waypoint."""
    tasks = list(_PURPOSES)
    kind_of = {"pick": tasks.index("pick"), "replenishment": tasks.index("replenish")}
    store, rest = tasks.index("store"), tasks.index("rest")
    kinds = [kind_of.get(station.kind.name, store) for station in layout.stations]
    task = np.array([*kinds, store, rest])[counted["stays_purpose"]]
    at = counted["stays_waypoint"] * len(tasks) + task
    cells = layout.waypoints * len(tasks)
    sums = np.bincount(at, counted[f"stays_{what}"], cells).reshape(-1, len(tasks))
    return {f"{one}_{what}": sums[:, column] for column, one in enumerate(tasks)}
