"""Traffic: robots on a waypoint graph, with conflict-free plans in continuous time.

This is a thin interface to the compiled core. It knows nothing of orders, SKUs or tasks: it accepts
programs ("drive there, lift this pod, go to that station") and yields events.
"""

from __future__ import annotations

from rmfs.traffic._core import Motion
from rmfs.traffic.settings import (
    COST_TABLE_BYTES,
    EXPANSION_BUDGET,
    TIME_WINDOWS,
    PlannerSettings,
)
from rmfs.traffic.trace import joined_holds
from rmfs.traffic.traffic import Traffic
from rmfs.traffic.vocabulary import (
    CutOff,
    EventKind,
    Piece,
    PlannedMove,
    Step,
    TrafficEvent,
    TripKind,
)

__all__ = [
    "COST_TABLE_BYTES",
    "EXPANSION_BUDGET",
    "TIME_WINDOWS",
    "CutOff",
    "EventKind",
    "Motion",
    "Piece",
    "PlannedMove",
    "PlannerSettings",
    "Step",
    "Traffic",
    "TrafficEvent",
    "TripKind",
    "joined_holds",
]
