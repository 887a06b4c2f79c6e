"""The table of stations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rmfs.layout.model import PickStation
from rmfs.measure.steps import Steps, covered
from rmfs.measure.tables import logs
from rmfs.measure.tables.orders import completed, orders
from rmfs.measure.tables.tidy import log, tidy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import ReplenishmentStation
    from rmfs.measure.recorder import Recorder


def stations(recorder: Recorder) -> pd.DataFrame:
    """One row per station in the common numbering."""
    layout = recorder.layout
    number = list(range(len(layout.stations)))
    place = np.array([station.waypoint for station in layout.stations], np.int64)
    visits = logs.visits(recorder)
    visits = visits[(visits["units"] > 0) | (visits["bundles"] > 0)]
    units = logs.measured(recorder, logs.units(recorder))
    edges = np.array([recorder.start_s, recorder.end_s])
    busy = np.array([np.diff(busy_until(recorder, one, edges))[0] for one in number])
    return tidy(
        "stations",
        {
            "station": number,
            "kind": [_kind(station) for station in layout.stations],
            "waypoint": place,
            "tier": layout.tier[place],
            "x_m": layout.x_m[place],
            "y_m": layout.y_m[place],
            "queue_places": [len(station.queue) for station in layout.stations],
            "visits": _count(visits["station"], len(number)),
            "visit_time_mean_s": (visits["end_s"] - visits["begin_s"])
            .groupby(visits["station"])
            .mean()
            .reindex(number)
            .to_numpy(),
            "units_picked": _count(units["station"], len(number)),
            "late_bound_units": _count(units["station"][units["late_bound"]], len(number)),
            "lines_picked": _count(
                logs.measured(recorder, logs.lines(recorder))["station"], len(number)
            ),
            "orders_completed": _count(completed(orders(recorder))["station"], len(number)),
            "bundles_stored": _count(
                logs.measured(recorder, logs.stored(recorder))["station"], len(number)
            ),
            "busy_s": busy,
            "idle_share": 1.0 - busy / recorder.duration_s,
            "active_share": _active_shares(recorder),
            "units_per_h_bound": [bound(station) for station in layout.stations],
        },
    )


def bound(station: PickStation | ReplenishmentStation) -> float:
    """Return the units per hour a pick station handles if it never waits for a pod.

    One unit keeps the station for `unit_transfer_s` and the robot for `unit_pick_s`, and the
    station serves one robot at a time, so the longer of the two bounds the rate whatever the
    pile-on is.

    Returns
    -------
    float
        3600 / max(unit_transfer_s, unit_pick_s); nan for a replenishment station, infinite if
        handling takes no time.
    """
    if not isinstance(station, PickStation):
        return float("nan")
    slowest = max(station.unit_transfer_s, station.unit_pick_s)
    return 3600.0 / slowest if slowest > 0 else float("inf")


def busy_until(recorder: Recorder, station: int, at_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how long a station has been busy up to each time, in s."""
    intervals = np.array(
        sorted((begin, end) for one, begin, end in recorder.busy if one == station), np.float64
    ).reshape(-1, 2)
    return covered(intervals[:, 0], intervals[:, 1], at_s)


def _kind(station: PickStation | ReplenishmentStation) -> str:
    return "pick" if isinstance(station, PickStation) else "replenishment"


def _count(station: pd.Series, stations: int) -> NDArray[np.int64]:
    return np.bincount(station.to_numpy(np.int64), minlength=stations)


def _active_shares(recorder: Recorder) -> list[float]:
    """Return the share of the measured time each station was on; all are at the start."""
    switches = log(recorder.activations, "time_s", "station", "active")
    shares = []
    for number in range(len(recorder.layout.stations)):
        own = switches[switches["station"] == number]
        state = own["active"].to_numpy(np.float64)
        change = np.diff(np.concatenate([[1.0], state]))
        on = Steps(own["time_s"].to_numpy(np.float64), change, 1.0)
        shares.append(on.mean(recorder.start_s, recorder.end_s))
    return shares
