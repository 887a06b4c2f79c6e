"""POA picker-load: orders as they came, to the picker who will be done with everything first."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.filling import Filling

if TYPE_CHECKING:
    from rmfs.world.stations import PickStation


class PickerLoadParameters(Parameters):
    """Parameters of POA picker-load."""

    fatigue_weight: Annotated[float, pydantic.Field(ge=0, le=100)] = 0.0
    """Share by which the work of a picker at fatigue 1 counts more than its time says; evenly less
    below. 0: only time counts; at 100 the tired get nothing while others have slots."""


class PickerLoad(Filling[PickerLoadParameters]):
    """Balances work over pickers: who is slow, or tired, gets fewer units.

    Orders are taken as they came; one that stock cannot serve is passed over. It goes to the
    station where the units of all open orders, this one among them, take its picker the least time
    now: speed, learning and fatigue count. Stations without a picker come last. Without pickers in
    the scenario units take the times of the layout. Ties: the lowest number.
    """

    parameters_model = PickerLoadParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the order that came first, and a station by the work of its picker."""
        order = self.oldest_order()
        if order is None:
            return None
        units = sum(line.units for line in order.lines)

        def work(station: PickStation) -> tuple[float, int]:
            there = units + sum(one.unpicked_units for one in station.orders.values())
            seconds = self._unit_s(station)
            return there * seconds, there if seconds == inf else 0

        return AssignOrder(order, min(stations, key=work).index)

    def _unit_s(self, station: PickStation) -> float:
        """Return what a unit counts at a station, in s."""
        view, staff = self.view, self.view.staff
        if staff is None:
            return view.layout.pick_stations[station.index].unit_transfer_s
        picker = staff.at_station[station.index]
        if picker is None:
            return inf
        tired = self.parameters.fatigue_weight * staff.fatigue(picker, view.now_s)
        return staff.unit_s(station.index, view.now_s) * (1.0 + tired)
