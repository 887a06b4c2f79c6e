"""Audit of stock: whether pods hold the units picked from them and keep within their capacity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.audit.report import Chapter
from rmfs.measure.audit.rows import Rows, running
from rmfs.measure.events import Happening

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.layout.model import Layout

HAIR = 1e-6
"""Tolerance for rounding errors in sums of space."""


def check(layout: Layout, rows: Rows, skus: pd.DataFrame, pods: pd.DataFrame) -> Chapter:
    """Check the stock on pods over time, and the final stock.

    A pod must hold every unit that is picked from it, and must not exceed its capacity. The final
    stock in the tables must agree with the events.

    Parameters
    ----------
    skus, pods
        The tables `skus` and `pods` of the run, which contain the final stock.
    """
    moved = rows.of_kind(Happening.STOCK, Happening.BUNDLE_STORED, Happening.UNIT_PICKED)
    named = (moved.pod >= 0) & (moved.sku >= 0) & (moved.units > 0)
    faults = moved.lines(~named, "the pod, the SKU or the number of units is missing")
    initial = moved.kind == Happening.STOCK
    faults += moved.lines(
        initial & (moved.time_us > 0), "initial stock must be recorded at time zero"
    )
    moved = moved.taken(named)
    sign = np.where(moved.kind == Happening.UNIT_PICKED, -1, 1)
    units = (sign * moved.units).astype(np.float64)
    order, there = running((moved.pod, moved.sku), units)
    faults += moved.taken(order).lines(there < 0, "the pod holds no unit of this SKU")
    space = skus["space"].to_numpy(np.float64)[moved.sku] * units
    order, used = running((moved.pod,), space)
    full = used > np.asarray(layout.pod_capacity)[moved.pod[order]] + HAIR
    faults += moved.taken(order).lines(full, "the pod holds more than its capacity")
    used_end = np.bincount(moved.pod, weights=space, minlength=layout.pods)
    off = np.abs(used_end - pods["used_end"].to_numpy(np.float64)) > HAIR
    faults += [
        f"table pods: used_end of pod {pod} differs from the {used_end[pod]:g} space units that "
        "follow from the events"
        for pod in np.flatnonzero(off)
    ]
    left = np.bincount(moved.sku, weights=units, minlength=len(skus))
    off = left != skus["units_end"].to_numpy(np.float64)
    faults += [
        f"table skus: units_end of SKU {sku} differs from the {left[sku]:g} units that follow "
        "from the events"
        for sku in np.flatnonzero(off)
    ]
    return Chapter("stock", f"{len(moved)} movements of units of {len(skus)} SKUs", faults)
