"""Check of stays: assignment of stays of pods to zones of storage locations (places)."""

from __future__ import annotations

from math import fsum, inf
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Return the robot time of all stays; a place is free again as soon as its pod leaves."""
    zone = values["zone"].tolist()
    capacity = data["capacity"].tolist()
    within("zone", zone, 0, len(capacity))
    parts = []
    # ends before begins of the same instant
    changes = []
    for stay, at in enumerate(zone):
        cost = float(data["cost_s"][stay, at])
        require(cost < inf, f"zone[{stay}]: zone {at} is not allowed")
        parts.append(cost)
        changes.append((float(data["begin_s"][stay]), 1, at))
        changes.append((float(data["end_s"][stay]), -1, at))
    there = [0] * len(capacity)
    for time, change, at in sorted(changes, key=lambda one: one[:2]):
        there[at] += change
        require(there[at] <= capacity[at], f"zone: zone {at} has no free location at {time} s")
    return fsum(parts)
