"""The neighbouring tiles to which a robot may drive from each tile.

One-way traffic follows the rule of RAWSim-O's default layout. Rows and columns of tiles are counted
from 0 at the north-west corner of the ring road. In aisles, on the ring road and across halls, even
rows run east and odd rows west; even columns run north and odd columns south. Lanes along a hall
alternate in direction; the outermost one runs in the direction of the ring road beside the hall.
These are the directions for a ring that runs counter-clockwise in pictures, where y points upwards
and south is therefore at the top. For a clockwise ring, all of them are reversed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout.generator.compass import Direction, Tile
from rmfs.layout.generator.extent import Extent, extent
from rmfs.layout.generator.tiles import Kind

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.layout.generator.buffers import Step
    from rmfs.layout.parameters import LayoutParameters

LOOP_LINES = 2
"""Number of lanes beside the buffers along a hall with the pattern "tim": one per direction."""


class TrafficRules:
    """Directed edges between the storage, aisle, ring and hall tiles of a tier.

    Parameters
    ----------
    parameters
        Parameters of the layout.
    kinds
        Kind of each tile, shape (rows, columns).
    """

    def __init__(self, parameters: LayoutParameters, kinds: NDArray[np.int8]) -> None:
        self._parameters = parameters
        self._kinds = kinds
        self._size: Extent = extent(parameters)

    def steps(self, tile: Tile) -> Iterator[Step]:
        """Yield the edges that leave a tile, except those into buffers."""
        for direction in self._directions(tile):
            target = direction.step(tile)
            if self._kind(target) not in (Kind.NOTHING, Kind.BUFFER):
                yield tile, target

    def _directions(self, tile: Tile) -> set[Direction]:
        kind = self._kind(tile)
        if self._is_grid(kind):
            return set(Direction)
        match kind:
            case Kind.ROW_AISLE:
                return {self._along_row(tile), Direction.NORTH, Direction.SOUTH}
            case Kind.COLUMN_AISLE:
                return {self._along_column(tile), Direction.EAST, Direction.WEST}
            case Kind.CROSSING:
                return {self._along_row(tile), self._along_column(tile)}
            case Kind.RING:
                return self._from_ring(tile)
            case _:
                return self._from_hall(tile)

    def _is_grid(self, kind: Kind) -> bool:
        """Whether tiles of this kind lead to all four neighbours."""
        if kind == Kind.STORAGE:
            return True
        if kind == Kind.HALL and self._parameters.hall_pattern == "highway":
            return False
        return self._parameters.two_directional_aisles

    def _from_ring(self, tile: Tile) -> set[Direction]:
        """Return the directions along the ring and into storage locations, lanes and aisles."""
        flows = {self._along_row(tile), self._along_column(tile)}
        storage = {d for d in Direction if self._kind(d.step(tile)) == Kind.STORAGE}
        return flows | storage

    def _from_hall(self, tile: Tile) -> set[Direction]:
        """Return the directions across the hall and, if a lane runs along it, along the hall."""
        row, column = tile[0] - self._size.top, tile[1] - self._size.left
        flows = set()
        if 0 <= row < self._size.height:
            flows.add(self._along_row(tile))
        elif self._has_line(_beyond(row, self._size.height)):
            flows.add(
                self._line(Direction.EAST if row < 0 else Direction.WEST, row, self._size.height)
            )
        if 0 <= column < self._size.width:
            flows.add(self._along_column(tile))
        elif self._has_line(_beyond(column, self._size.width)):
            flows.add(
                self._line(
                    Direction.NORTH if column < 0 else Direction.SOUTH, column, self._size.width
                )
            )
        return flows

    def _has_line(self, beyond: int) -> bool:
        """Whether a lane runs along the hall this many tiles outside the ring road."""
        highway = self._parameters.hall_pattern == "highway"
        return highway or self._parameters.hall_width - beyond < LOOP_LINES

    def _line(self, with_ring: Direction, position: int, length: int) -> Direction:
        """Return the direction of a lane along a hall; the outermost lane runs with the ring."""
        inner = (self._parameters.hall_width - _beyond(position, length)) % 2
        return self._sense(with_ring.opposite if inner else with_ring)

    def _along_row(self, tile: Tile) -> Direction:
        east = (tile[0] - self._size.top) % 2 == 0
        return self._sense(Direction.EAST if east else Direction.WEST)

    def _along_column(self, tile: Tile) -> Direction:
        north = (tile[1] - self._size.left) % 2 == 0
        return self._sense(Direction.NORTH if north else Direction.SOUTH)

    def _sense(self, direction: Direction) -> Direction:
        """Return `direction` if the ring is counter-clockwise, otherwise the opposite one."""
        return direction if self._parameters.counter_clockwise_ring else direction.opposite

    def _kind(self, tile: Tile) -> Kind:
        row, column = tile
        if 0 <= row < self._size.rows and 0 <= column < self._size.columns:
            return Kind(self._kinds[row, column])
        return Kind.NOTHING


def _beyond(position: int, length: int) -> int:
    """Return how many tiles a row or column lies outside the ring road."""
    return -position if position < 0 else position - length + 1
