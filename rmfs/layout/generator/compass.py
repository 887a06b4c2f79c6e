"""Compass directions on the tile grid, and the four sides of a tier.

Rows are numbered from north to south and columns from west to east: y grows towards the south.
"""

from __future__ import annotations

from enum import IntEnum

Tile = tuple[int, int]
"""A tile as (row, column)."""


class Direction(IntEnum):
    """Direction of travel; the numbers of opposite directions differ by 2."""

    NORTH = 0
    EAST = 1
    SOUTH = 2
    WEST = 3

    @property
    def opposite(self) -> Direction:
        """The opposite direction."""
        return Direction((self + 2) % 4)

    def step(self, tile: Tile, tiles: int = 1) -> Tile:
        """Return the tile reached from `tile` after `tiles` steps in this direction."""
        rows, columns = _STEP[self]
        return tile[0] + tiles * rows, tile[1] + tiles * columns


_STEP = ((-1, 0), (0, 1), (1, 0), (0, -1))

SIDES = (Direction.EAST, Direction.WEST, Direction.NORTH, Direction.SOUTH)
"""The sides of a tier in the order in which stations are numbered (RAWSim-O)."""
