"""The table of stations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.model import PickStation, ReplenishmentStation
from rmfs.measure.columns import INTEGER, REAL, TEXT, Column
from rmfs.measure.steps import Steps, covered
from rmfs.measure.tables.at_pile_on import units_per_h
from rmfs.measure.tables.logs import count
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout, OtherStation
    from rmfs.measure.tables.logs import Logs

    Station = PickStation | ReplenishmentStation | OtherStation


STATIONS = (
    Column(
        "station",
        INTEGER,
        "",
        "Number of the station; pick stations come first, then replenishment stations",
    ),
    Column("kind", TEXT, "", "pick, replenishment, or the name of another kind"),
    Column("waypoint", INTEGER, "", "Waypoint at which the robot stands while its pod is served"),
    Column("tier", INTEGER, "", "Floor"),
    Column("x_m", REAL, "m", "x coordinate"),
    Column("y_m", REAL, "m", "y coordinate"),
    Column(
        "queue_places", INTEGER, "places", "Places in the queue, including the place at the station"
    ),
    Column(
        "visits",
        INTEGER,
        "visits",
        "Visits of pods in which at least one unit or bundle was handled; for other kinds of "
        "stations, all visits in the table `visits`",
    ),
    Column("visit_time_mean_s", REAL, "s", "Mean duration of the visits that have ended"),
    Column("units_picked", INTEGER, "units", "Units picked"),
    Column(
        "late_bound_units",
        INTEGER,
        "units",
        "Picked units that were bound to their pod after a robot had got the task to bring it",
    ),
    Column("lines_picked", INTEGER, "lines", "Order lines finished"),
    Column("orders_completed", INTEGER, "orders", "Orders completed"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored"),
    Column(
        "busy_s",
        REAL,
        "s",
        "Time spent handling units or bundles; for other kinds of stations, serving pods or robots",
    ),
    Column("idle_share", REAL, "share", "1 - busy_s / duration"),
    Column("active_share", REAL, "share", "Time switched on / duration"),
    Column(
        "units_per_h_at_pile_on",
        REAL,
        "1/h",
        "As in `footprint`, for this station; empty for other kinds of stations",
    ),
    Column("units_per_visit", REAL, "units", "Pile-on: units_picked / visits"),
    Column("orders_per_visit", REAL, "orders", "orders_completed / visits"),
    Column("bundles_per_visit", REAL, "bundles", "bundles_stored / visits"),
    Column(
        "order_slots",
        INTEGER,
        "orders",
        "Number of order slots; 0 for stations other than pick stations",
    ),
    Column(
        "capacity",
        REAL,
        "space units",
        "Maximum total space of the bundles assigned to the station at a time; empty for "
        "stations other than replenishment stations",
    ),
    Column(
        "without_work_share",
        REAL,
        "share",
        "Share of the measured time in which no order or part of one (pick station) or no "
        "bundle (replenishment station) was assigned to the station; empty for other kinds",
    ),
)


def stations(logs: Logs) -> pd.DataFrame:
    """Return one row per station: first pick stations, then replenishment stations, then others."""
    layout = logs.layout
    number = len(layout.stations)
    place = np.array([station.waypoint for station in layout.stations], np.int64)
    works = len(layout.pick_stations) + len(layout.replenishment_stations)
    handled = (logs.visits["units"] > 0) | (logs.visits["bundles"] > 0)
    # a visit in which something was handled in the measured time has not ended before it
    seen = ~(logs.visits["end_s"] < logs.start_s)
    visits = logs.visits[handled | ((logs.visits["station"] >= works) & seen)]
    units, orders = logs.units_now, logs.orders
    visited = count(visits["station"], number)
    pile_on = _per(count(units["station"], number), visited)
    done = orders["completed_s"] >= logs.start_s
    edges = np.array([logs.start_s, logs.end_s])
    busy = np.array([np.diff(busy_until(logs, one, edges))[0] for one in range(number)])
    return tidy(
        "stations",
        STATIONS,
        {
            "station": np.arange(number),
            "kind": [station.kind.name for station in layout.stations],
            "waypoint": place,
            "tier": layout.tier[place],
            "x_m": layout.x_m[place],
            "y_m": layout.y_m[place],
            "queue_places": [len(station.queue) for station in layout.stations],
            "visits": visited,
            "visit_time_mean_s": _mean_visit(visits, number),
            "units_picked": count(units["station"], number),
            "late_bound_units": count(units["station"][units["late_bound"]], number),
            "lines_picked": count(logs.lines_now["station"], number),
            "orders_completed": count(orders["station"][done], number),
            "bundles_stored": count(logs.stored_now["station"], number),
            "busy_s": busy,
            # rounding must not make it negative
            "idle_share": np.maximum(1.0 - busy / logs.duration_s, 0.0),
            "active_share": [_active_share(logs, one) for one in range(number)],
            "units_per_h_at_pile_on": [
                _at_pile_on(layout, station, piled, with_pickers=logs.world.staff is not None)
                for station, piled in zip(layout.stations, pile_on, strict=True)
            ],
            "units_per_visit": pile_on,
            "orders_per_visit": _per(count(orders["station"][done], number), visited),
            "bundles_per_visit": _per(count(logs.stored_now["station"], number), visited),
            "order_slots": [getattr(station, "order_slots", 0) for station in layout.stations],
            "capacity": [getattr(station, "capacity", np.nan) for station in layout.stations],
            "without_work_share": [_without_work(logs, one) for one in range(number)],
        },
    )


def busy_until(logs: Logs, station: int, at_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the total busy time of a station, in s, from time zero to each time in `at_s`."""
    own = logs.busy[logs.busy["station"].to_numpy() == station]
    return covered(own["begin_s"].to_numpy(), own["end_s"].to_numpy(), at_s)


def _at_pile_on(
    layout: Layout, station: Station, units_per_visit: float, *, with_pickers: bool
) -> float:
    """Return the units per hour of a pick station; without visits, as if pods never changed."""
    if not isinstance(station, PickStation) or with_pickers:
        return float("nan")
    return units_per_h(layout, station, units_per_visit if units_per_visit > 0 else float("inf"))


def _per(amount: NDArray[np.int64], visits: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the amount per visit at each station; nan if it had no visit."""
    result = np.full(len(visits), np.nan)
    np.divide(amount, visits, out=result, where=visits > 0)
    return result


def _without_work(logs: Logs, station: int) -> float:
    """Return the share of the measured time in which nothing was assigned to a station."""
    match logs.layout.stations[station]:
        case PickStation():
            # not the table of orders: it has only one station for each split order
            work, names = logs.slots, ("begin_s", "end_s")
        case ReplenishmentStation():
            work, names = logs.bundles, ("assigned_s", "time_s")
        case _:
            return float("nan")
    own = work["station"].to_numpy() == station
    begin, end = (work[name].to_numpy()[own] for name in names)
    return 1.0 - Steps.between(begin, end).positive().mean(logs.start_s, logs.end_s)


def _mean_visit(visits: pd.DataFrame, stations: int) -> NDArray[np.float64]:
    """Return the mean duration of completed visits to each station, in s; nan if there are none."""
    ended = visits[visits["end_s"].notna()]
    length = (ended["end_s"] - ended["begin_s"]).to_numpy()
    number = count(ended["station"], stations)
    total = np.bincount(ended["station"].to_numpy(), weights=length, minlength=stations)
    mean = np.full(stations, np.nan)
    np.divide(total, number, out=mean, where=number > 0)
    return mean


def _active_share(logs: Logs, station: int) -> float:
    """Return the share of the measured time in which a station was active; initially, all are."""
    own = logs.switches[logs.switches["station"].to_numpy() == station]
    change = np.diff(np.concatenate([[1.0], own["active"].to_numpy(np.float64)]))
    return Steps(own["time_s"].to_numpy(), change, 1.0).mean(logs.start_s, logs.end_s)
