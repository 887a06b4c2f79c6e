"""The kind of every tile of a tier: storage, aisle, crossing, ring road, hall, buffer or none."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.generator.compass import SIDES, Direction
from rmfs.layout.generator.extent import BLOCK_DEPTH, Extent, extent, lanes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.parameters import LayoutParameters


class Kind(IntEnum):
    """Kind of a tile."""

    NOTHING = 0
    STORAGE = 1
    ROW_AISLE = 2
    COLUMN_AISLE = 3
    CROSSING = 4
    RING = 5
    HALL = 6
    BUFFER = 7


ROAD = (Kind.ROW_AISLE, Kind.COLUMN_AISLE, Kind.CROSSING, Kind.RING, Kind.HALL)
"""Tiles where robots may stand at the start."""


def tile_kinds(parameters: LayoutParameters) -> NDArray[np.int8]:
    """Return the kind of each tile of a tier, shape (rows, columns), before buffers are added.

    Buffers and pockets are added later; until then, the tiles of buffers are `NOTHING`, and those
    of pockets are `STORAGE`.
    """
    size = extent(parameters)
    kinds = np.full((size.rows, size.columns), Kind.NOTHING, dtype=np.int8)
    rectangle = kinds[size.top : size.top + size.height, size.left : size.left + size.width]
    rectangle[...] = _storage_rectangle(parameters)
    for side in SIDES:
        if size.margin[side]:
            kinds[_hall(size, side, parameters.hall_width)] = Kind.HALL
    if parameters.hall_pattern == "highway":
        _fill_corners(kinds, size, parameters.hall_width)
    return kinds


def _storage_rectangle(parameters: LayoutParameters) -> NDArray[np.int8]:
    width = lanes(parameters)
    row_aisle = _aisle_lines(parameters.horizontal_aisles, BLOCK_DEPTH, width)[:, None]
    column_aisle = _aisle_lines(parameters.vertical_aisles, parameters.block_length, width)[None, :]
    kinds = np.full((row_aisle.size, column_aisle.size), Kind.STORAGE, dtype=np.int8)
    kinds[np.broadcast_to(row_aisle, kinds.shape)] = Kind.ROW_AISLE
    kinds[np.broadcast_to(column_aisle, kinds.shape)] = Kind.COLUMN_AISLE
    kinds[row_aisle & column_aisle] = Kind.CROSSING
    kinds[[0, -1], :] = Kind.RING
    kinds[:, [0, -1]] = Kind.RING
    return kinds


def _aisle_lines(aisles: int, block: int, width: int) -> NDArray[np.bool_]:
    """Return which rows (columns) between the sides of the ring road are aisles, ring included."""
    period = [False] * block + [True] * width
    return np.array([False, *(period * aisles), *([False] * block), False])


def _hall(size: Extent, side: Direction, width: int) -> tuple[slice, slice]:
    """Return the rows and columns of the hall between the ring road and the buffers of a side."""
    rows = slice(size.top, size.top + size.height)
    columns = slice(size.left, size.left + size.width)
    match side:
        case Direction.NORTH:
            return slice(size.top - width, size.top), columns
        case Direction.SOUTH:
            return slice(rows.stop, rows.stop + width), columns
        case Direction.WEST:
            return rows, slice(size.left - width, size.left)
        case Direction.EAST:
            return rows, slice(columns.stop, columns.stop + width)


def _fill_corners(kinds: NDArray[np.int8], size: Extent, width: int) -> None:
    """Fill the corner between two neighbouring halls with hall tiles ("highway" only)."""
    for vertical in (Direction.NORTH, Direction.SOUTH):
        for horizontal in (Direction.WEST, Direction.EAST):
            if size.margin[vertical] and size.margin[horizontal]:
                rows, _ = _hall(size, vertical, width)
                _, columns = _hall(size, horizontal, width)
                kinds[rows, columns] = Kind.HALL
