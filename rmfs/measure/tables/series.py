"""The time series of a run: one row per minute."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, Column
from rmfs.measure.energy import WH
from rmfs.measure.recorder import TASKS
from rmfs.measure.steps import Steps, counts
from rmfs.measure.tables.robots import STATES, with_task
from rmfs.measure.tables.stations import busy_until
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.tables.logs import Logs

    Floats = NDArray[np.float64]


SERIES = (
    Column("time_s", REAL, "s", "End of the interval"),
    Column(
        "interval_s",
        REAL,
        "s",
        "Length of the interval: one minute; the last interval may be shorter",
    ),
    Column("units_picked", INTEGER, "units", "Units picked in the interval"),
    Column("lines_picked", INTEGER, "lines", "Order lines finished in the interval"),
    Column("orders_created", INTEGER, "orders", "Orders that arrived in the interval"),
    Column("orders_completed", INTEGER, "orders", "Orders completed in the interval"),
    Column("bundles_created", INTEGER, "bundles", "Bundles that arrived in the interval"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored in the interval"),
    Column("distance_m", REAL, "m", "Distance driven in the interval"),
    Column(
        "backlog_orders",
        INTEGER,
        "orders",
        "Orders in the backlog at the end of the interval",
    ),
    Column("open_orders", INTEGER, "orders", "Open orders at stations at the end of the interval"),
    Column(
        "backlog_bundles",
        INTEGER,
        "bundles",
        "Bundles not yet assigned to both a pod and a station at the end of the interval",
    ),
    Column(
        "inventory_share",
        REAL,
        "share",
        "Space used by stored units / capacity of all pods, at the end of the interval",
    ),
    Column(
        "pick_station_busy_share",
        REAL,
        "share",
        "Share of the interval in which pick stations handled units, mean over the stations",
    ),
    Column(
        "replenishment_station_busy_share",
        REAL,
        "share",
        "Share of the interval in which replenishment stations handled bundles, mean over "
        "the stations",
    ),
    *(
        Column(
            f"robots_task_{task}",
            INTEGER,
            "robots",
            f"Robots with a {task} task at the end of the interval",
        )
        for task in ("pick", "replenish", "park", "reposition", "rest")
    ),
    *(
        Column(
            f"robots_{state}", REAL, "robots", f"Mean number, over the interval, of robots {what}"
        )
        for state, what in {
            "moving": "driving",
            "turning": "turning",
            "waiting": "standing during a trip or in a queue",
            "served": "standing at a station",
            "transfer": "lifting or setting down",
            "riding": "in an elevator",
            "idle": "standing idle",
            "queueing": "that have entered the queue zone of a station and not yet reached the "
            "station (also counted in the columns above)",
        }.items()
    ),
    Column(
        "energy_wh", REAL, "Wh", "Energy drawn in the interval; empty if energy is not modelled"
    ),
    Column(
        "charged_wh", REAL, "Wh", "Energy charged in the interval; empty if energy is not modelled"
    ),
    Column(
        "level_mean_wh",
        REAL,
        "Wh",
        "Mean energy in the batteries at the end of the interval; empty without batteries",
    ),
    Column(
        "level_least_wh",
        REAL,
        "Wh",
        "Lowest energy in any battery at the end of the interval; empty without batteries",
    ),
)


def series(logs: Logs) -> pd.DataFrame:
    """Return one row per minute of the measured time; the last row may cover less than a minute.

    Counts and means refer to the whole minute; backlogs, stock, tasks and battery levels refer to
    its end.
    """
    ends = np.array([time for time, _ in logs.recorder.samples])
    edges = np.concatenate([[logs.start_s], ends])
    length = np.diff(edges)
    orders, bundles = logs.orders, logs.bundles
    driven = motion_per_interval(logs)
    columns: dict[str, Any] = {
        "time_s": ends,
        "interval_s": length,
        "units_picked": counts(logs.units_now["time_s"], edges),
        "lines_picked": counts(logs.lines_now["time_s"], edges),
        "orders_created": counts(orders["created_s"], edges),
        "orders_completed": counts(orders["completed_s"], edges),
        "bundles_created": counts(bundles["created_s"], edges),
        "bundles_stored": counts(bundles["time_s"], edges),
        "distance_m": driven["distance_m"],
        "backlog_orders": Steps.between(
            orders["created_s"], orders["assigned_s"].fillna(orders["cancelled_s"])
        ).at(ends),
        "open_orders": Steps.between(orders["assigned_s"], orders["completed_s"]).at(ends),
        "backlog_bundles": Steps.between(bundles["created_s"], bundles["assigned_s"]).at(ends),
        "inventory_share": inventory_share(logs).at(ends),
    }
    for kind in ("pick", "replenishment"):
        columns[f"{kind}_station_busy_share"] = _busy_share(logs, edges, kind)
    for task in TASKS:
        columns[f"robots_task_{task}"] = with_task(logs, task).at(ends)
    for state in STATES:
        columns[f"robots_{state}"] = driven[f"{state}_s"] / length
    energy = logs.recorder.energy
    counted = bool(energy.samples)
    columns["energy_wh"] = energy.per_interval_wh(0) if counted else np.nan
    columns["charged_wh"] = energy.per_interval_wh(1) if counted else np.nan
    for name, which in (("level_mean_wh", 2), ("level_least_wh", 3)):
        levels = [sample[which] / WH for sample in energy.samples]
        columns[name] = levels if counted else np.nan
    return tidy("series", SERIES, columns)


def motion_per_interval(logs: Logs) -> dict[str, Floats]:
    """Return the fleet's distances (m) and times (s) in each interval, as arrays by name.

    The names are those of `MotionCounts.motion`; the intervals are the rows of the table `series`.
    """
    samples = logs.recorder.samples
    names = samples[0][1].keys()
    return {name: np.diff([0.0, *(totals[name] for _, totals in samples)]) for name in names}


def inventory_share(logs: Logs) -> Steps:
    """Return the used share of the capacity of all pods as a function of time."""
    inventory = logs.world.inventory
    taken = -inventory.unit_space[logs.units["sku"].to_numpy()]
    time = np.concatenate([logs.units["time_s"].to_numpy(), logs.stored["time_s"].to_numpy()])
    change = np.concatenate([taken, logs.stored["space"].to_numpy()])
    initial = logs.recorder.stored_space_start / inventory.total_capacity
    return Steps(time, change / inventory.total_capacity, initial)


def _busy_share(logs: Logs, edges: Floats, kind: str) -> Floats:
    """Return the mean busy share of the stations of one kind in each interval."""
    chosen = [
        number for number, station in enumerate(logs.layout.stations) if station.kind.name == kind
    ]
    if not chosen:
        return np.full(len(edges) - 1, np.nan)
    busy = sum(np.diff(busy_until(logs, number, edges)) for number in chosen)
    share: Floats = busy / (np.diff(edges) * len(chosen))
    return share
