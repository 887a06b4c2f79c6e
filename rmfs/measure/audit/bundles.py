"""Audit of bundles, from arrival to storage, and of the binding of units to pods."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.model import ReplenishmentStation
from rmfs.measure.audit.report import Chapter
from rmfs.measure.audit.rows import running
from rmfs.measure.events import Happening

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.layout.model import Layout
    from rmfs.measure.audit.rows import Rows

STEPS = (Happening.BUNDLE_CREATED, Happening.BUNDLE_ASSIGNED, Happening.BUNDLE_STORED)
HAIR = 1e-6


def check(layout: Layout, rows: Rows, skus: pd.DataFrame) -> Chapter:
    """Check that the events of each bundle are its arrival, assignment and storage, in this order.

    The later events are missing if the run ended before them. The events of a bundle must agree on
    its SKU, units, pod and station. The bundles that are assigned to a replenishment station and
    not yet stored must not exceed the station's capacity.
    """
    steps = rows.of_kind(*STEPS)
    order = np.lexsort((steps.number, steps.order))
    mine = steps.taken(order)
    step = np.searchsorted(np.array(STEPS), mine.kind)
    same = np.append(False, mine.order[1:] == mine.order[:-1])
    before = np.append(-1, step[:-1])
    faults = mine.lines(
        step != np.where(same, before + 1, 0),
        "a bundle must arrive, be assigned and be stored once each, in this order",
    )
    changed = np.zeros(len(mine), np.bool_)
    for name, since in (("sku", 1), ("units", 1), ("pod", 2), ("station", 2)):
        column = getattr(mine, name)
        changed |= same & (step >= since) & np.append(False, column[1:] != column[:-1])
    faults += mine.lines(
        changed, "SKU, units, pod or station differ from those of the bundle's earlier event"
    )
    space = skus["space"].to_numpy(np.float64)[np.maximum(mine.sku, 0)] * mine.units
    at = np.flatnonzero(step > 0)
    told = mine.taken(at)
    here = np.lexsort((told.number, told.station))
    told, load = (
        told.taken(here),
        (space[at] * np.where(step[at] == 1, 1.0, -1.0))[here].astype(np.float64),
    )
    order, loads = running((told.station,), load)
    room = {
        number: station.capacity
        for number, station in enumerate(layout.stations)
        if isinstance(station, ReplenishmentStation)
    }
    capacity = np.array([room.get(int(one), -1.0) for one in told.station[order]])
    faults += told.taken(order).lines(
        loads > capacity + HAIR, "the bundle exceeds the station's capacity"
    )
    return Chapter(
        "bundles", f"{int((step == 0).sum())} arrived, {int((step == 2).sum())} stored", faults
    )


def check_bound(rows: Rows) -> Chapter:
    """Check that every unit, when it was picked, was bound to the pod from which it was picked."""
    kinds = (Happening.UNITS_BOUND, Happening.UNITS_UNBOUND, Happening.UNIT_PICKED)
    mine = rows.of_kind(*kinds)
    units = np.where(mine.kind == Happening.UNITS_BOUND, mine.units, -mine.units).astype(np.float64)
    keys = (mine.order, mine.sku, mine.pod, mine.robot, mine.station)
    order, left = running(keys, units)
    faults = mine.taken(order).lines(left < 0, "the pod was not brought for this unit")
    bound = int(mine.units[mine.kind == Happening.UNITS_BOUND].sum())
    return Chapter("tasks", f"{bound} units bound to pods", faults)
