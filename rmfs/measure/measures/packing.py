"""Measures of orders between pick stations and packing; empty without packing."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import COUNT_OR_EMPTY, LESS, MORE, REAL, Column
from rmfs.measure.measures.reckoning import ratio
from rmfs.measure.steps import Steps
from rmfs.measure.tables.logs import framed

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.ended import EndedRun


class Packing(Measure):
    """Times until orders are packed, use of put wall and packers, and blocked order slots."""

    columns = (
        Column(
            "orders_packed",
            COUNT_OR_EMPTY,
            "orders",
            "Orders packed; this column and the following ones up to packing_wait_mean_s are "
            "empty if the scenario has no packing",
            better=MORE,
        ),
        Column(
            "orders_packed_split_share",
            REAL,
            "share",
            "Share of the packed orders that consisted of several totes",
        ),
        Column(
            "totes_per_order",
            REAL,
            "totes",
            "Mean number of totes per packed order",
            better=LESS,
        ),
        Column(
            "order_cycle_mean_s",
            REAL,
            "s",
            "Mean time from the arrival of an order until it is packed",
            better=LESS,
        ),
        Column(
            "order_cycle_p95_s",
            REAL,
            "s",
            "95th percentile of the time from the arrival of an order until it is packed",
            better=LESS,
        ),
        Column(
            "consolidation_time_mean_s",
            REAL,
            "s",
            "Mean time between the arrivals of the first and the last tote of a split order at "
            "the put wall",
            better=LESS,
        ),
        Column(
            "wall_slots_mean",
            REAL,
            "slots",
            "Time average of the number of slots in use at the put wall; the totes of an order, "
            "including those carried by hand, occupy slots until the last of them has arrived",
            better=LESS,
        ),
        Column(
            "wall_slots_max",
            REAL,
            "slots",
            "Maximum number of slots in use at the put wall at the same time",
            better=LESS,
        ),
        Column(
            "totes_held_mean",
            REAL,
            "totes",
            "Time average of the number of totes that cannot leave their pick stations and "
            "therefore block order slots there",
            better=LESS,
        ),
        Column(
            "station_blocked_share",
            REAL,
            "share",
            "totes_held_mean / number of order slots of all pick stations",
            better=LESS,
        ),
        Column(
            "totes_by_hand",
            COUNT_OR_EMPTY,
            "totes",
            "Totes carried by hand because they had waited too long at their stations",
            better=LESS,
        ),
        Column(
            "packer_busy_share",
            REAL,
            "share",
            "Share of the packers' time spent on packing; empty if the number of packers is "
            "unlimited",
        ),
        Column(
            "packing_wait_mean_s",
            REAL,
            "s",
            "Mean time that a complete order waits for a packer",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return counts, times and utilisation of packing; None or nan if there is no packing."""
        given = run.recorder.packing.given
        if given is None:
            return {
                column.name: None if column.dtype == COUNT_OR_EMPTY else nan
                for column in self.columns
            }
        start_s, end_s = run.start_s, run.end_s
        parcels, totes = run.tables["parcels"], run.tables["totes"]
        packed = parcels[parcels["packed_s"] >= start_s]
        split = packed[packed["totes"] > 1]
        held = framed(run.recorder.packing.held)
        held_mean = Steps.between(held["begin_s"], held["end_s"]).mean(start_s, end_s)
        slots = sum(station.order_slots for station in run.layout.pick_stations)
        in_use = slots_in_use(totes, per_part=given.slot_for == "part")
        waited = parcels.loc[parcels["packing_s"] >= start_s]
        busy = Steps.between(parcels["packing_s"], parcels["packed_s"]).mean(start_s, end_s)
        return {
            "orders_packed": len(packed),
            "orders_packed_split_share": ratio(len(split), len(packed)),
            "totes_per_order": packed["totes"].mean(),
            "order_cycle_mean_s": packed["cycle_s"].mean(),
            "order_cycle_p95_s": packed["cycle_s"].quantile(0.95),
            "consolidation_time_mean_s": (split["consolidated_s"] - split["arrived_s"]).mean(),
            "wall_slots_mean": in_use.mean(start_s, end_s),
            "wall_slots_max": in_use.most(start_s, end_s),
            "totes_held_mean": held_mean,
            "station_blocked_share": ratio(held_mean, slots),
            "totes_by_hand": int((totes["by_hand"] & (totes["released_s"] >= start_s)).sum()),
            "packer_busy_share": nan if given.packers is None else busy / given.packers,
            "packing_wait_mean_s": (waited["packing_s"] - waited["consolidated_s"]).mean(),
        }


def slots_in_use(totes: pd.DataFrame, *, per_part: bool) -> Steps:
    """Return the number of slots in use in the put wall as a function of time.

    Parameters
    ----------
    totes
        The table `totes`.
    per_part
        Whether each part of an order takes a slot; if not, all parts of an order share one.
    """
    there = totes[totes["arrived_s"].notna()]
    if not per_part:
        there = there.groupby("order").agg({"arrived_s": "min", "consolidated_s": "first"})
    return Steps.between(there["arrived_s"], there["consolidated_s"])
