"""Features of the warehouse as a whole, for learning agents and network rules."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.features import LIMIT, Feature

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View

GLOBAL_FEATURES: tuple[Feature, ...] = (
    Feature("time_left", "share", 1.0, "remaining share of the run"),
    Feature("backlog_orders", "orders", 100.0, "orders waiting for a station"),
    Feature("waiting_bundles", "bundles", 100.0, "bundles without station or pod"),
    Feature("free_slots", "share", 1.0, "order slots of active pick stations that are free"),
    Feature("open_units", "units per station", 20.0, "units for which no pod is under way"),
    Feature("asking_robots", "share", 1.0, "robots that need a task"),
    Feature("resting_robots", "share", 1.0, "robots at rest"),
    Feature("loaded_robots", "share", 1.0, "robots with a pod"),
    Feature("stored_share", "share", 1.0, "space of all pods that is in use"),
)
"""Features of the whole warehouse."""

_ORDERS, _BUNDLES, _UNITS = (GLOBAL_FEATURES[at].scale for at in (1, 2, 4))


def overview(view: View) -> NDArray[np.float32]:
    """Return the features in `GLOBAL_FEATURES`, scaled and clipped, shape (9,)."""
    robots = len(view.robots)
    slots = taken = units = 0
    for station in view.pick_stations:
        units += station.requests.units
        if station.active:
            slots += station.slots
            taken += len(station.orders)
    inventory, storage = view.inventory, view.storage
    plain = (
        1.0 - view.now_s / view.end_s,
        len(view.orders) / _ORDERS,
        len(view.bundles) / _BUNDLES,
        1.0 - taken / slots if slots else 0.0,
        units / max(len(view.pick_stations), 1) / _UNITS,
        len(view.asking) / robots,
        len(view.resting) / robots,
        (len(storage.place_of) - np.count_nonzero(storage.is_stored)) / robots,
        inventory.stored_space / inventory.total_capacity,
    )
    found = np.array(plain, np.float32)
    np.minimum(found, LIMIT, out=found)
    return np.maximum(found, -LIMIT, out=found)
