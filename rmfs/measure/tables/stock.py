"""The tables of pods and SKUs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, TEXT, Column
from rmfs.measure.tables.logs import count
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs
    from rmfs.scenario.skus import SkuSet


PODS = (
    Column("pod", INTEGER, "", "Pod"),
    Column("capacity", REAL, "space units", "Capacity of the pod"),
    Column("used_end", REAL, "space units", "Space used by stored units at the end"),
    Column(
        "waypoint_end",
        INTEGER,
        "",
        "Waypoint at which the pod stands at the end; -1 if it is carried",
    ),
    Column("lifts", INTEGER, "lifts", "Number of times that the pod was lifted"),
    Column(
        "pick_visits",
        INTEGER,
        "visits",
        "Visits to pick stations in which at least one unit was picked",
    ),
    Column(
        "replenishment_visits",
        INTEGER,
        "visits",
        "Visits to replenishment stations in which at least one bundle was stored",
    ),
    Column("units_picked", INTEGER, "units", "Units picked from the pod"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored in the pod"),
)

SKUS = (
    Column("sku", INTEGER, "", "SKU"),
    Column(
        "name", TEXT, "", "Name in the file of SKUs, or the number of the SKU if it has no name"
    ),
    Column("popularity", REAL, "", "Relative weight with which the SKU is ordered"),
    Column("space", REAL, "space units", "Space of one unit"),
    Column("lines_picked", INTEGER, "lines", "Order lines finished"),
    Column("units_picked", INTEGER, "units", "Units picked"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored"),
    Column("units_end", INTEGER, "units", "Units in stock (on pods) at the end"),
    Column("pods_end", INTEGER, "pods", "Pods that hold units of the SKU at the end"),
)


def pods(logs: Logs) -> pd.DataFrame:
    """Return one row per pod: counts in the measured time, and the pod's state at the end."""
    number, visits = logs.layout.pods, logs.visits
    return tidy(
        "pods",
        PODS,
        {
            "pod": np.arange(number),
            "capacity": logs.world.inventory.capacity,
            "used_end": logs.world.inventory.used,
            "waypoint_end": logs.world.storage.place_of,
            "lifts": count(logs.lifts_now["pod"], number),
            "pick_visits": count(visits["pod"][visits["units"] > 0], number),
            "replenishment_visits": count(visits["pod"][visits["bundles"] > 0], number),
            "units_picked": count(logs.units_now["pod"], number),
            "bundles_stored": count(logs.stored_now["pod"], number),
        },
    )


def skus(logs: Logs) -> pd.DataFrame:
    """Return one row per SKU: counts in the measured time, and the units in stock at the end."""
    known = logs.world.skus
    number, contained = len(known), logs.world.inventory.contained
    return tidy(
        "skus",
        SKUS,
        {
            "sku": np.arange(number),
            "name": names_of_skus(known),
            "popularity": known.popularity,
            "space": known.space_per_unit,
            "lines_picked": count(logs.lines_now["sku"], number),
            "units_picked": count(logs.units_now["sku"], number),
            "bundles_stored": count(logs.stored_now["sku"], number),
            "units_end": contained.sum(axis=1),
            "pods_end": (contained > 0).sum(axis=1),
        },
    )


def names_of_skus(skus: SkuSet) -> list[str]:
    """Return the names of all SKUs or, if they have no names, their numbers as strings."""
    return list(skus.names) or [str(number) for number in skus.ids.tolist()]
