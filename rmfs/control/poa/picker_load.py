"""POA picker-load: sends each order to the picker who needs the least time for unpicked units."""

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
    """Weight of fatigue: the time that a picker needs is multiplied by 1 plus this weight times the
    picker's fatigue (0 to 1). A high weight, such as 100, keeps orders away from tired pickers as
    long as others have free slots."""


class PickerLoad(Filling[PickerLoadParameters]):
    """Balances work over pickers: slow or tired pickers get fewer units.

    Orders are assigned in the sequence of their arrival; those that stock cannot serve are skipped.
    Each order goes to the station whose picker, at the present speed, learning and fatigue, needs
    the least time for all units still to be picked there, including those of the new order.
    Stations without a picker come last. In scenarios without pickers, the time per unit is that of
    the station in the layout. Ties go to the station with the lowest number.
    """

    parameters_model = PickerLoadParameters

    def next_assignment(self, stations: list[PickStation]) -> AssignOrder | None:
        """Choose the oldest servable order, and the station whose picker needs the least time."""
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
        """Return the weighted time of a unit at a station, in s."""
        view, staff = self.view, self.view.staff
        if staff is None:
            return view.layout.pick_stations[station.index].unit_transfer_s
        picker = staff.at_station[station.index]
        if picker is None:
            return inf
        tired = self.parameters.fatigue_weight * staff.fatigue(picker, view.now_s)
        return staff.unit_s(station.index, view.now_s) * (1.0 + tired)
