"""POA workload: sends each order to the station with the fewest (or most) open orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.filling import Filling

if TYPE_CHECKING:
    from rmfs.world.stations import PickStation


class WorkloadParameters(Parameters):
    """Parameters of POA workload."""

    station: Literal["least-busy", "most-busy"] = "least-busy"
    """Choice of the station: the one with the fewest (`least-busy`) or the most (`most-busy`) open
    orders."""


class Workload(Filling[WorkloadParameters]):
    """Balances open orders over the stations or, with `most-busy`, fills one station after another.

    Orders are assigned in the sequence of their arrival; those that stock cannot serve are skipped.
    Ties between stations are broken at random.
    """

    parameters_model = WorkloadParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the oldest servable order, and a station by the number of open orders."""
        order = self.oldest_order()
        if order is None:
            return None
        counts = [len(station.orders) for station in stations]
        wanted = min(counts) if self.parameters.station == "least-busy" else max(counts)
        tied = [s for s, count in zip(stations, counts, strict=True) if count == wanted]
        return AssignOrder(order, tied[self.draw(len(tied)) if len(tied) > 1 else 0].index)
