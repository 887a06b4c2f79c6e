"""Audit of totals: figures in the tables of a run, compared with its events."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.audit.report import Chapter
from rmfs.measure.events import Happening

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.audit.rows import Rows

COUNTED = {
    "orders_completed": Happening.ORDER_COMPLETED,
    "units_picked": Happening.UNIT_PICKED,
    "bundles_stored": Happening.BUNDLE_STORED,
}


def check(
    rows: Rows, footprint: pd.Series, orders: pd.DataFrame, stations: pd.DataFrame
) -> Chapter:
    """Check that counts and completion times in the tables agree with the events."""
    begin_us = round(float(footprint["warmup_s"]) * 1e6)
    measured = rows.taken(rows.time_us >= begin_us)
    faults = []
    for name, kind in COUNTED.items():
        count = len(measured.of_kind(kind))
        if count != int(footprint[name]):
            faults.append(f"footprint: {name} is {footprint[name]}, but the events give {count}")
    picked = measured.of_kind(Happening.UNIT_PICKED)
    at = np.bincount(picked.station[picked.station >= 0], minlength=len(stations))
    off = at[: len(stations)] != stations["units_picked"].to_numpy()
    faults += [
        f"table stations: units_picked of station {one} differs from the {at[one]} picks recorded"
        for one in np.flatnonzero(off)
    ]
    done = rows.of_kind(Happening.ORDER_COMPLETED)
    when = dict(zip(done.order.tolist(), (done.time_us / 1e6).tolist(), strict=True))
    told = orders.loc[orders["completed_s"].notna(), ["order", "completed_s"]]
    for order, completed_s in told.itertuples(index=False):
        if abs(when.get(order, np.inf) - completed_s) > 1e-5:
            faults.append(
                f"table orders: completed_s of order {order} is {completed_s:.6f}, but no event "
                "completes the order at this time"
            )
    return Chapter(
        "tables", f"{len(COUNTED)} figures and {len(told)} completed orders compared", faults
    )
