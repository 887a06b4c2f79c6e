"""Recorded data of orders on their way from the pick stations to packing."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.measure.log import Log

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Packing
    from rmfs.world import World
    from rmfs.world.put_wall import Parcel


class PackingLog:
    """Records parcels (orders on their way to packing) and their totes; empty without packing.

    Attributes
    ----------
    given
        The scenario's packing parameters; None without packing.
    parcels
        Packed orders. After the end of the run, also the orders that are not yet packed, if at
        least one of their totes has left its pick station. Rows are as in `parcel_row`.
    totes
        Totes of these orders; `consolidated_s` is the time at which the last tote of the order
        reached the put wall.
    held
        Periods in which a tote could not leave its pick station, with start and end in s.
    """

    def __init__(self) -> None:
        self.given: Packing | None = None
        self._world: World | None = None
        self.parcels = Log(
            **{"order": "i4", "totes": "i4", "created_s": "f8", "due_s": "f8", "picked_s": "f8"},
            **{"arrived_s": "f8", "consolidated_s": "f8", "packing_s": "f8", "packed_s": "f8"},
        )
        self.totes = Log(
            **{"order": "i4", "station": "i2", "released_s": "f8", "arrived_s": "f8"},
            **{"consolidated_s": "f8", "by_hand": "?"},
        )
        self.held = Log(station="i2", begin_s="f8", end_s="f8")

    def begin(self, given: Packing, world: World) -> None:
        """Start recording."""
        self.given, self._world = given, world

    def packed(self, parcel: Parcel) -> None:
        """Record a parcel and its totes."""
        self.parcels.add(*parcel_row(parcel))
        for tote in parcel.totes:
            times = (tote.released_s, tote.arrived_s, parcel.consolidated_s)
            self.totes.add(parcel.order.index, tote.station, *times, tote.by_hand)

    def ended(self, time_s: float) -> None:
        """Record, at the end of the run, the parcels not packed yet and the totes still held."""
        wall = None if self._world is None else self._world.put_wall
        if wall is None:
            return
        for parcel in wall.parcels.values():
            self.packed(parcel)
        for held in wall.held:
            self.held.add(held.order.station, held.since_s, time_s)


def parcel_row(parcel: Parcel) -> tuple[Any, ...]:
    """Return the row of a parcel in `PackingLog.parcels`."""
    order = parcel.order
    first_s = parcel.totes[0].arrived_s
    for tote in parcel.totes:
        # a tote that has not arrived has nan, which compares as false
        if tote.arrived_s < first_s or first_s != first_s:
            first_s = tote.arrived_s
    return (
        order.index,
        len(parcel.totes),
        order.created_s,
        order.due_s,
        order.completed_s if parcel.picked else nan,
        first_s,
        parcel.consolidated_s,
        parcel.packing_s,
        parcel.packed_s,
    )
