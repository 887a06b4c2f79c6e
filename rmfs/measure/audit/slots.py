"""Audit of the order slots of pick stations: how many are in use, and by which orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.audit.report import Chapter
from rmfs.measure.events import Happening

if TYPE_CHECKING:
    from rmfs.layout.model import Layout
    from rmfs.measure.audit.rows import Rows

KINDS = (
    *(Happening.ORDER_ASSIGNED, Happening.UNIT_PICKED, Happening.ORDER_COMPLETED),
    *(Happening.PART_COMPLETED, Happening.STATION_SWITCHED),
)


def check(layout: Layout, rows: Rows) -> Chapter:
    """Check that no pick station has more open orders than slots.

    Also checks that a station picks only for orders that have a slot there, and that no order is
    assigned to a station that is switched off.
    """
    rows = rows.of_kind(*KINDS)
    slots = {number: one.order_slots for number, one in enumerate(layout.pick_stations)}
    at: dict[int, set[int]] = {number: set() for number in slots}
    split = set(rows.of_kind(Happening.PART_COMPLETED).order.tolist())
    done: set[int] = set()
    off: set[int] = set()
    faults, taken = [], 0
    columns = (rows.kind, rows.order, rows.station, rows.units)
    told = zip(*(column.tolist() for column in columns), strict=True)
    for row, (kind, order, station, units) in enumerate(told):
        if kind == Happening.STATION_SWITCHED:
            (off.discard if units else off.add)(station)
            continue
        if station not in at:
            faults.append(rows.tell(row, f"station {station} is not a pick station"))
            continue
        here = at[station]
        if kind == Happening.ORDER_COMPLETED:
            done.add(order)
            if order in split:
                continue  # its last part leaves by itself
        if kind == Happening.ORDER_ASSIGNED:
            if order in here:
                continue  # lines join a part that is there
            taken += 1
            here.add(order)
            if len(here) > slots[station]:
                faults.append(
                    rows.tell(
                        row,
                        f"station {station} has {len(here)} open orders, but only "
                        f"{slots[station]} slots",
                    )
                )
            if station in off:
                faults.append(rows.tell(row, f"station {station} is switched off"))
        elif kind == Happening.UNIT_PICKED:
            if order not in here:
                faults.append(rows.tell(row, f"order {order} has no slot at station {station}"))
        elif order in here:
            here.discard(order)
        else:
            faults.append(rows.tell(row, f"order {order} has no slot at station {station}"))
    for station, here in at.items():
        faults += [
            f"order {order} is completed, but still has a slot at station {station}"
            for order in here & done
        ]
    return Chapter("slots", f"{taken} taken at pick stations", faults)
