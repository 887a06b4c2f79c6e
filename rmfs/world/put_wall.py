"""The put wall: orders that have left the pick stations and are not packed yet.

Every order, or part of one, leaves its pick station in a tote. As soon as all n totes of an order
have arrived at the wall, they are taken out together. The tote that leaves its station last
therefore needs no slot, and an order occupies at most n - 1 slots. A tote that needs a slot waits
at its station until one is free, and reserves this slot when it leaves. A tote that has waited too
long is carried to the wall by hand, even if the wall is full.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isnan, nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.world.orders import Order


@dataclass(slots=True, eq=False)
class Tote:
    """A tote with an order, or a part of one, that has left its pick station.

    Attributes
    ----------
    parcel
        The parcel to which the tote belongs.
    station
        The pick station that the tote has left.
    released_s
        Time in s at which the tote left the station.
    arrived_s
        Time in s at which the tote reached the wall; nan until then, and if the order is packed
        without using the wall.
    by_hand
        Whether the tote was carried to the wall by hand because it had waited too long at its
        station.
    """

    parcel: Parcel
    station: int
    released_s: float
    arrived_s: float = nan
    by_hand: bool = False


@dataclass(slots=True, eq=False)
class Parcel:
    """An order on its way from the pick stations through the put wall.

    Attributes
    ----------
    order
        The customer's order.
    totes
        Totes that have left the pick stations so far.
    picked
        Whether all totes of the order have left the pick stations.
    standing
        Number of totes that have reached the wall.
    kept
        Number of slots of the wall that the order occupies or has reserved.
    consolidated_s
        Time in s at which the last tote of the order reached the wall.
    packing_s, packed_s
        Times in s at which packing of the order started and ended.
    """

    order: Order
    totes: list[Tote] = field(default_factory=list)
    picked: bool = False
    standing: int = 0
    kept: int = 0
    consolidated_s: float = nan
    packing_s: float = nan
    packed_s: float = nan

    @property
    def is_split(self) -> bool:
        """Whether the order leaves the pick stations in more than one tote."""
        return len(self.totes) > 1 or not self.picked


@dataclass(slots=True, eq=False)
class HeldTote:
    """An order, or part of one, that has been picked but cannot leave its pick station yet.

    Attributes
    ----------
    order
        The order or part; it still occupies its slot at the station.
    since_s
        Time in s at which the tote was ready to leave.
    timer
        Serial number of the scheduled event at which the tote will be carried to the wall by hand;
        -1 if there is none.
    """

    order: Order
    since_s: float
    timer: int = -1


class PutWall:
    """State of the put wall; simulated by `rmfs.simulation.packing`.

    Parameters
    ----------
    slots
        Number of slots; None: unlimited.
    slot_per_part
        Whether each part of an order takes a slot; otherwise, all parts of an order share one slot.

    Attributes
    ----------
    parcels
        Parcels by index of the order. An order has a parcel from the time when its first tote
        leaves the pick station until the order is packed.
    kept
        Number of slots occupied, or reserved for totes on their way.
    travelling
        Number of totes on their way.
    held
        Totes that cannot leave their pick stations yet, longest waiting first.
    orders_packed
        Number of orders packed since time zero.
    """

    def __init__(self, slots: int | None, *, slot_per_part: bool) -> None:
        self.slots = slots
        self.slot_per_part = slot_per_part
        self.parcels: dict[int, Parcel] = {}
        self.kept = 0
        self.travelling = 0
        self.held: list[HeldTote] = []
        self.orders_packed = 0

    def has_room(self, order: int, *, last: bool) -> bool:
        """Whether the next tote of an order would find room; one that needs no slot always does.

        Parameters
        ----------
        order
            Index of the order.
        last
            Whether this tote is the last of the order.
        """
        more = self._more(order, last)
        # totes carried by hand may have filled the wall beyond its slots
        return self.slots is None or more == 0 or self.kept + more <= self.slots

    def release(self, order: Order, station: int, now_s: float, *, last: bool) -> Tote:
        """Create a tote that leaves its pick station, and reserve a slot if it needs one.

        Parameters
        ----------
        order
            The customer's order.
        last
            Whether this tote is the last of the order.
        """
        more = self._more(order.index, last)
        parcel = self.parcels.setdefault(order.index, Parcel(order))
        parcel.kept += more
        self.kept += more
        parcel.picked = last
        tote = Tote(parcel, station, now_s)
        parcel.totes.append(tote)
        self.travelling += 1
        return tote

    def pass_by(self, tote: Tote, now_s: float) -> Parcel:
        """Record that an order in one tote is packed without using the wall; return its parcel."""
        self.travelling -= 1
        tote.parcel.packing_s = now_s
        self.pack(tote.parcel, now_s)
        return tote.parcel

    def arrive(self, tote: Tote, now_s: float) -> bool:
        """Record the arrival of a tote.

        Returns
        -------
        bool
            Whether the order is now complete, so that its totes are taken out of the wall.
        """
        parcel = tote.parcel
        tote.arrived_s = now_s
        self.travelling -= 1
        parcel.standing += 1
        if not parcel.picked or parcel.standing < len(parcel.totes):
            return False
        parcel.consolidated_s = now_s
        self.kept -= parcel.kept
        parcel.kept = 0
        return True

    def pack(self, parcel: Parcel, now_s: float) -> None:
        """Record that a parcel is packed."""
        parcel.packed_s = now_s
        del self.parcels[parcel.order.index]
        self.orders_packed += 1

    def _more(self, order: int, last: bool) -> int:
        """Return the number of slots that the next tote of an order takes."""
        return int(not last and (self.slot_per_part or order not in self.parcels))

    def verify(self) -> None:
        """Check all counts against a recount.

        Raises
        ------
        AssertionError
            If a count is wrong.
        """
        kept = travelling = 0
        for parcel in self.parcels.values():
            arrived = [tote for tote in parcel.totes if not isnan(tote.arrived_s)]
            own = len(parcel.totes) - parcel.picked
            if not self.slot_per_part:
                own = min(own, 1)
            kept += own if isnan(parcel.consolidated_s) else 0
            travelling += len(parcel.totes) - len(arrived)
            if parcel.standing != len(arrived):
                raise AssertionError("inconsistent world: totes at the put wall")
        if (kept, travelling) != (self.kept, self.travelling):
            raise AssertionError("inconsistent world: slots of the put wall")
