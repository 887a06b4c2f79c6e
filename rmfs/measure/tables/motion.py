"""The tables that traffic counts: trips and heat."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs

TRIP_KINDS = np.array(["to_pod", "to_station", "to_storage", "to_rest"])


def trips(logs: Logs) -> pd.DataFrame:
    """Trips that ended during the measured time, by their end."""
    told = logs.recorder.trips
    return tidy(
        "trips",
        {
            "robot": told["robot"],
            "kind": TRIP_KINDS[told["kind"]],
            "from_waypoint": told["from_wp"],
            "to_waypoint": told["to_wp"],
            "start_s": told["t0_us"] / 1e6,
            "end_s": told["t1_us"] / 1e6,
            "loaded": told["loaded"],
            "distance_m": told["distance_m"],
            "unhindered_s": told["unhindered_s"],
        },
    )


def heat(logs: Logs) -> pd.DataFrame:
    """One row per waypoint."""
    layout = logs.layout
    return tidy(
        "heat",
        {
            "waypoint": np.arange(layout.waypoints),
            "tier": layout.tier,
            "x_m": layout.x_m,
            "y_m": layout.y_m,
            **logs.recorder.heat,
        },
    )
