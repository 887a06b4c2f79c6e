"""The positions of stations and elevators along the sides of a tier.

As in RAWSim-O's default layout, the exit of a buffer must be opposite an aisle that robots can
enter from the buffer's side of the tier. Each station or elevator takes one of these possible
exits; on each side, the exits nearest the middle are used. From north to south, or from west to
east, pick stations come first, then replenishment stations, stations of other kinds, and elevators.
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
        Where robots leave and enter the buffer: positions in tiles from the northern or western end
        of the ring road on this side of the tier.
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
    """Return the positions opposite aisles that robots can enter and that are far enough apart."""
    aisles, width = aisles_at(parameters, side), lanes(parameters)
    pitch = block_at(parameters, side) + width
    first = RING_WIDTH + block_at(parameters, side)
    if parameters.two_directional_aisles:
        if parameters.entry_exit_distance < pitch:
            return range(first, first + aisles * pitch, pitch)
    elif _towards_low_end(parameters, side):
        first += pitch + width - 1
    return range(first, first + aisles // 2 * 2 * pitch, 2 * pitch)
