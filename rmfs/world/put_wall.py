"""The put wall: what has left the pick stations and is not packed yet.

Every order, or part of one, leaves its pick station in a tote. Of an order in n totes the last one
to leave needs no slot of the wall: when the last of them arrives, wherever it comes from, all are
taken out together, so that at most n - 1 stand there at a time. A slot is kept for a tote from the
moment at which it leaves its station, so that no tote finds the wall full.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isnan, nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.world.orders import Order


@dataclass(slots=True, eq=False)
class Tote:
    """What a pick station has handed on of an order.

    Attributes
    ----------
    parcel
        What it will be a part of.
    station
        The pick station.
    released_s
        When it left the station.
    arrived_s
        When it reached the wall; nan on its way, and if it never goes there.
    by_hand
        Whether it was carried there by hand after its station had waited too long.
    """

    parcel: Parcel
    station: int
    released_s: float
    arrived_s: float = nan
    by_hand: bool = False


@dataclass(slots=True, eq=False)
class Parcel:
    """An order after the pick stations.

    Attributes
    ----------
    order
        The order as the customer wants it.
    totes
        What has left the pick stations so far.
    picked
        Whether that is all of it.
    standing
        Totes that have reached the wall.
    kept
        Slots of the wall that are kept for it, or taken.
    consolidated_s
        When the last of its totes reached the wall.
    packing_s, packed_s
        When a packer began, and ended.
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
        """Whether it has left pick stations, or will, in more than one tote."""
        return len(self.totes) > 1 or not self.picked


@dataclass(slots=True, eq=False)
class HeldTote:
    """An order, or a part of one, that a pick station cannot let go.

    Attributes
    ----------
    order
        What has the slot of the station.
    since_s
        From when on it could have gone.
    timer
        Names the moment at which it is carried away by hand.
    """

    order: Order
    since_s: float
    timer: int = -1


class PutWall:
    """State of the wall; simulated by `rmfs.simulation.packing`.

    Parameters
    ----------
    slots
        How many there are; None for as many as are needed.
    slot_per_part
        Whether each part of an order takes one, or all of them share one.

    Attributes
    ----------
    parcels
        Of which something has left the pick stations and that are not packed yet, by order.
    kept
        Slots taken, or kept for totes on their way.
    travelling
        Totes on their way.
    held
        Totes that pick stations cannot let go, longest first.
    orders_packed
        Since time zero.
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
        """Whether the next tote of an order would find room.

        Parameters
        ----------
        order
            Index of the order.
        last
            Whether no tote follows.
        """
        return self.slots is None or self.kept + self._more(order, last) <= self.slots

    def release(self, order: Order, station: int, now_s: float, *, last: bool) -> Tote:
        """Let a tote leave its pick station; it keeps the slot that it will need.

        Parameters
        ----------
        order
            As the customer wants it.
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
        """Let an order in a single tote be packed where it was picked; returns the parcel."""
        self.travelling -= 1
        tote.parcel.packing_s = now_s
        self.pack(tote.parcel, now_s)
        return tote.parcel

    def arrive(self, tote: Tote, now_s: float) -> bool:
        """Let a tote reach the wall; returns whether its order is all there, and taken out."""
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
        """Let a parcel be done."""
        parcel.packed_s = now_s
        del self.parcels[parcel.order.index]
        self.orders_packed += 1

    def _more(self, order: int, last: bool) -> int:
        """Slots that the next tote of an order takes."""
        return int(not last and (self.slot_per_part or order not in self.parcels))

    def verify(self) -> None:
        """Check what is known by recounting.

        Raises
        ------
        AssertionError
            Naming what is wrong.
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
