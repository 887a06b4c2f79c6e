"""Dimensions of a tier: the storage rectangle and what each side adds to it.

As in RAWSim-O's default layout, tiles measure 1 m x 1 m. The storage rectangle (blocks, aisles and
ring road) lies in the middle; each side with stations or elevators adds a hall and a buffer zone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rmfs.layout.generator.compass import SIDES, Direction

if TYPE_CHECKING:
    from rmfs.layout.parameters import LayoutParameters

BLOCK_DEPTH = 2
"""Number of rows of a storage block."""

RING_WIDTH = 1
"""Width of the ring road in tiles."""


@dataclass(frozen=True, slots=True)
class Extent:
    """Size of a tier, in tiles.

    Attributes
    ----------
    height, width
        Rows and columns of the storage rectangle, ring road included.
    margin
        For each side, the distance from the storage rectangle to the edge of the tier: the width of
        hall and buffer zone together, or 0 if the side has neither.
    """

    height: int
    width: int
    margin: dict[Direction, int]

    @property
    def rows(self) -> int:
        """Number of rows of the tier."""
        return self.height + self.margin[Direction.NORTH] + self.margin[Direction.SOUTH]

    @property
    def columns(self) -> int:
        """Number of columns of the tier."""
        return self.width + self.margin[Direction.WEST] + self.margin[Direction.EAST]

    @property
    def top(self) -> int:
        """Row of the north side of the ring road."""
        return self.margin[Direction.NORTH]

    @property
    def left(self) -> int:
        """Column of the west side of the ring road."""
        return self.margin[Direction.WEST]


def lanes(parameters: LayoutParameters) -> int:
    """Return the width of an aisle in tiles."""
    return 1 if parameters.single_lane else 2


def aisles_at(parameters: LayoutParameters, side: Direction) -> int:
    """Return the number of aisles that end at a side of the storage rectangle."""
    across = side in (Direction.EAST, Direction.WEST)
    return parameters.horizontal_aisles if across else parameters.vertical_aisles


def block_at(parameters: LayoutParameters, side: Direction) -> int:
    """Return the length of a storage block, in tiles, measured parallel to a side of the tier."""
    across = side in (Direction.EAST, Direction.WEST)
    return BLOCK_DEPTH if across else parameters.block_length


def sites_at(parameters: LayoutParameters, side: Direction) -> int:
    """Return the number of stations and elevators on a side of a tier."""
    name = side.name.lower()
    groups = [parameters.pick_stations, parameters.replenishment_stations, parameters.elevators]
    groups += parameters.other_stations.values()
    return sum(int(getattr(group, name)) for group in groups)


def extent(parameters: LayoutParameters) -> Extent:
    """Return the size of a tier."""

    def across(side: Direction) -> int:
        aisles, block = aisles_at(parameters, side), block_at(parameters, side)
        return (aisles + 1) * block + aisles * lanes(parameters) + 2 * RING_WIDTH

    depth = parameters.hall_width + parameters.buffer_width
    margin = {side: depth if sites_at(parameters, side) else 0 for side in SIDES}
    return Extent(height=across(Direction.EAST), width=across(Direction.NORTH), margin=margin)


def storage_places(parameters: LayoutParameters) -> int:
    """Return the number of storage locations of a tier."""
    within = sum(group.within for group in parameters.other_stations.values())
    return blocks(parameters) * parameters.block_length * BLOCK_DEPTH - within


def blocks(parameters: LayoutParameters) -> int:
    """Return the number of storage blocks of a tier."""
    return (parameters.vertical_aisles + 1) * (parameters.horizontal_aisles + 1)


def road_tiles(parameters: LayoutParameters) -> int:
    """Return the number of tiles of a tier in aisles, ring road, halls and pockets.

    Pockets hold the stations within the storage area.
    """
    size = extent(parameters)
    rectangle = size.height * size.width - storage_places(parameters)
    open_sides = {side for side in SIDES if size.margin[side]}
    lengths = [
        size.width if side in (Direction.NORTH, Direction.SOUTH) else size.height
        for side in open_sides
    ]
    halls = parameters.hall_width * sum(lengths)
    corners = 0
    if parameters.hall_pattern == "highway":
        ends = [{Direction.NORTH, Direction.SOUTH}, {Direction.EAST, Direction.WEST}]
        corners = len(open_sides & ends[0]) * len(open_sides & ends[1])
    return rectangle + halls + corners * parameters.hall_width**2
