"""The tables of parcels and totes; empty if the scenario has no packing.

An order becomes a parcel when its first tote leaves a pick station. A split order has one tote for
each of its parts; any other order has one tote.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.columns import FLAG, INTEGER, REAL, Column
from rmfs.measure.tables.logs import framed
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs

PARCELS = (
    Column("order", INTEGER, "", "Order, as in the table `orders`"),
    Column("totes", INTEGER, "totes", "Number of totes of the order that have left pick stations"),
    Column("created_s", REAL, "s", "Time of arrival of the order"),
    Column("due_s", REAL, "s", "Due time of the order"),
    Column(
        "picked_s",
        REAL,
        "s",
        "Time at which the last tote of the order left its pick station; empty if not yet",
    ),
    Column(
        "arrived_s",
        REAL,
        "s",
        "Time at which the first tote of the order reached the put wall; empty if none has",
    ),
    Column(
        "consolidated_s",
        REAL,
        "s",
        "Time at which the last tote of the order reached the put wall; empty if not yet, or "
        "if the order was packed without using the wall",
    ),
    Column(
        "packing_s", REAL, "s", "Time at which a packer started to pack the order; empty if not yet"
    ),
    Column("packed_s", REAL, "s", "Time at which the order was packed; empty if not yet"),
    Column("cycle_s", REAL, "s", "packed_s - created_s"),
)

TOTES = (
    Column("order", INTEGER, "", "Order, as in the table `orders`"),
    Column("station", INTEGER, "", "Pick station"),
    Column("released_s", REAL, "s", "Time at which the tote left the pick station"),
    Column(
        "arrived_s",
        REAL,
        "s",
        "Time at which the tote reached the put wall; empty if not yet, or if the order was "
        "packed without using the wall",
    ),
    Column(
        "consolidated_s",
        REAL,
        "s",
        "Time at which the last tote of the order reached the put wall; empty if not yet, or "
        "if the order was packed without using the wall",
    ),
    Column(
        "by_hand",
        FLAG,
        "",
        "Whether the tote was carried by hand because it had waited too long at its station",
    ),
)


def parcels(logs: Logs) -> pd.DataFrame:
    """Return one row per order of which at least one tote has left its pick station.

    The rows are sorted by the arrival of the orders. Orders packed before the measured time are
    left out.
    """
    frame = _seen(logs).sort_values("order", ignore_index=True)
    frame["cycle_s"] = frame["packed_s"] - frame["created_s"]
    return tidy("parcels", PARCELS, frame)


def totes(logs: Logs) -> pd.DataFrame:
    """Return one row per tote that has left its pick station, for the orders in `parcels`."""
    frame = framed(logs.recorder.packing.totes)
    frame = frame[frame["order"].isin(_seen(logs)["order"])]
    frame = frame.sort_values(["order", "released_s"], kind="stable", ignore_index=True)
    return tidy("totes", TOTES, frame)


def _seen(logs: Logs) -> pd.DataFrame:
    """Return the parcels that were not packed before the measured time."""
    frame = framed(logs.recorder.packing.parcels)
    return frame[~(frame["packed_s"] < logs.start_s)]
