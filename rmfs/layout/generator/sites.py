"""Where stations and elevators stand along the sides of a tier.

RAWSim-O default layout: robots can leave the buffer of a station only opposite an aisle that can be
entered from that side. On each side of a tier, stations and elevators take the possible exits in
the middle, one each. From north to south, or from west to east, pick stations come first, then
replenishment stations, stations of other kinds, and elevators.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rmfs.layout.generator.compass import Direction
from rmfs.layout.generator.extent import RING_WIDTH, aisles_at, block_at, lanes

if TYPE_CHECKING:
    from rmfs.layout.parameters import LayoutParameters, PerSide


@dataclass(frozen=True, slots=True)
class Site:
    """The place of one station or elevator.

    Attributes
    ----------
    kind
        Name of the kind of station, or `elevator`.
    exit, entrance
        Positions along the side at which robots leave and enter its buffer, in tiles from the
        northern or western end of the ring road on that side.
    """

    kind: str
    side: Direction
    exit: int
    entrance: int


def sites(parameters: LayoutParameters, side: Direction) -> list[Site]:
    """Return the sites of one side, sorted by the position of their exits."""
    name = side.name.lower()
    groups: tuple[tuple[str, PerSide], ...] = (
        ("pick", parameters.pick_stations),
        ("replenishment", parameters.replenishment_stations),
        *parameters.other_stations.items(),
        ("elevator", parameters.elevators),
    )
    kinds = [kind for kind, group in groups for _ in range(getattr(group, name))]
    exits = _possible_exits(parameters, side)
    first = max(0, (len(exits) - len(kinds)) // 2)
    reach = parameters.entry_exit_distance
    reach = -reach if _towards_low_end(parameters, side) else reach
    return [
        Site(kind, side, position, position + reach)
        for kind, position in zip(kinds, exits[first:], strict=False)
    ]


def _towards_low_end(parameters: LayoutParameters, side: Direction) -> bool:
    """Whether a buffer extends from its exit north or west, against the ring road."""
    low = side in (Direction.WEST, Direction.SOUTH)
    return low if parameters.counter_clockwise_ring else not low


def _possible_exits(parameters: LayoutParameters, side: Direction) -> range:
    """Return the places opposite aisles that run inward (two-directional: all that have room)."""
    aisles, width = aisles_at(parameters, side), lanes(parameters)
    pitch = block_at(parameters, side) + width
    first = RING_WIDTH + block_at(parameters, side)
    if parameters.two_directional_aisles:
        if parameters.entry_exit_distance < pitch:
            return range(first, first + aisles * pitch, pitch)
    elif _towards_low_end(parameters, side):
        first += pitch + width - 1
    return range(first, first + aisles // 2 * 2 * pitch, 2 * pitch)
