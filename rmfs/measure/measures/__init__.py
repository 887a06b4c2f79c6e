"""The measures of rmfs: one module per topic, each declaring and computing its columns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.measures.decisions import Decisions, Optimisers
from rmfs.measure.measures.delays import Delays
from rmfs.measure.measures.disturbances import Disturbances
from rmfs.measure.measures.energy import Batteries, Energy
from rmfs.measure.measures.heading import Heading
from rmfs.measure.measures.motion import Motion, RobotTime
from rmfs.measure.measures.orders import Backlog, OrderTimes
from rmfs.measure.measures.packing import Packing
from rmfs.measure.measures.pickers import Pickers
from rmfs.measure.measures.planning import Planning, Safety
from rmfs.measure.measures.replenishment import Inventory, Replenishment
from rmfs.measure.measures.service import Service
from rmfs.measure.measures.shortage import ShortOrders
from rmfs.measure.measures.speed import Speed
from rmfs.measure.measures.stations import Stations
from rmfs.measure.measures.throughput import Potential, Throughput
from rmfs.measure.measures.visits import Visits

if TYPE_CHECKING:
    from rmfs.measure.base import Measure

SHIPPED: tuple[type[Measure], ...] = (
    Heading,
    Throughput,
    Potential,
    Visits,
    Motion,
    RobotTime,
    Stations,
    OrderTimes,
    Delays,
    Backlog,
    Replenishment,
    Inventory,
    Planning,
    Safety,
    Disturbances,
    Energy,
    Batteries,
    Packing,
    Pickers,
    Service,
    ShortOrders,
    Decisions,
    Optimisers,
    Speed,
)
"""The measures of every run, in the order of the footprint's further columns."""
