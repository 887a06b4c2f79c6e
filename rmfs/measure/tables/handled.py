"""The tables of picks, bundles and visits."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

from rmfs.measure.columns import FLAG, INTEGER, REAL, Column
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs


PICKS = (
    Column("time_s", REAL, "s", "Time at which the pick of the unit started"),
    Column("order", INTEGER, "", "Order, as in the table `orders`"),
    Column("sku", INTEGER, "", "SKU"),
    Column("pod", INTEGER, "", "Pod"),
    Column("robot", INTEGER, "", "Robot that brought the pod"),
    Column("station", INTEGER, "", "Pick station"),
    Column(
        "late_bound",
        FLAG,
        "",
        "Whether the unit was bound to the pod after the robot had got its task",
    ),
    Column(
        "picker",
        INTEGER,
        "",
        "Picker, as in the table `pickers`. If pickers are not modelled, the columns picker, "
        "layer and face are -1, handling_s and fatigue are empty, and error, noticed and "
        "turned are false",
    ),
    Column("handling_s", REAL, "s", "Time that the picker spent on the unit, rework included"),
    Column(
        "layer",
        INTEGER,
        "",
        "Layer of the pod from which the unit was picked, 0 at the bottom; -1 if pods have "
        "no layers",
    ),
    Column("fatigue", REAL, "share", "Fatigue level of the picker at the start of the pick"),
    Column("error", FLAG, "", "Whether the unit was picked wrongly"),
    Column("noticed", FLAG, "", "Whether the error was noticed and corrected"),
    Column(
        "face",
        INTEGER,
        "",
        "Face of the pod from which the unit was picked; -1 if pods have no faces",
    ),
    Column("turned", FLAG, "", "Whether the pod was turned at the station for this unit"),
)

BUNDLES = (
    Column("sku", INTEGER, "", "SKU"),
    Column("units", INTEGER, "units", "Units in the bundle"),
    Column("space", REAL, "space units", "Total space of these units"),
    Column("created_s", REAL, "s", "Time of arrival"),
    Column(
        "assigned_s",
        REAL,
        "s",
        "Time at which both the pod and the station had been decided; empty if not yet",
    ),
    Column(
        "stored_s", REAL, "s", "Time at which the transfer into the pod started; empty if not yet"
    ),
    Column("pod", INTEGER, "", "Pod; -1 if not yet decided"),
    Column("station", INTEGER, "", "Replenishment station; -1 if not yet decided"),
    Column("robot", INTEGER, "", "Robot that brought the pod; -1 if not yet stored"),
    Column("turnover_s", REAL, "s", "stored_s - created_s"),
    Column("throughput_time_s", REAL, "s", "stored_s - assigned_s"),
)

VISITS = (
    Column("station", INTEGER, "", "Station"),
    Column("pod", INTEGER, "", "Pod"),
    Column("robot", INTEGER, "", "Robot"),
    Column(
        "begin_s", REAL, "s", "Time at which the robot reached the station; may be in the warm-up"
    ),
    Column("end_s", REAL, "s", "Time at which the robot left the station; empty if not yet"),
    Column("units", INTEGER, "units", "Units picked in the measured time"),
    Column("bundles", INTEGER, "bundles", "Bundles stored in the measured time"),
)


def picks(logs: Logs) -> pd.DataFrame:
    """Return one row per unit picked in the measured time."""
    frame = logs.units_now.reset_index(drop=True)
    if logs.recorder.pickers.staff is not None:
        frame = frame.join(logs.picks_by_hand)
    else:
        nothing = {"picker": -1, "handling_s": nan, "layer": -1, "fatigue": nan, "face": -1}
        frame = frame.assign(**nothing, error=False, noticed=False, turned=False)
    return tidy("picks", PICKS, frame)


def bundles(logs: Logs) -> pd.DataFrame:
    """Return one row per bundle, except bundles stored before the measured time.

    The rows are sorted by arrival.
    """
    frame = seen_bundles(logs).drop(columns="in_file")
    frame["turnover_s"] = frame["stored_s"] - frame["created_s"]
    frame["throughput_time_s"] = frame["stored_s"] - frame["assigned_s"]
    return tidy("bundles", BUNDLES, frame)


def seen_bundles(logs: Logs) -> pd.DataFrame:
    """Return the bundles of the table `bundles`, with their positions in the file of bundles.

    The position (`in_file`) is -1 for a bundle that was not read from a file.
    """
    frame = logs.bundles.rename(columns={"time_s": "stored_s"})
    frame = frame[~(frame["stored_s"] < logs.start_s)]
    return frame.sort_values("created_s", kind="stable", ignore_index=True)


def visits(logs: Logs) -> pd.DataFrame:
    """Return one row per visit to a station, except visits that ended before the measured time."""
    frame = logs.visits
    return tidy("visits", VISITS, frame[~(frame["end_s"] < logs.start_s)].reset_index(drop=True))
