"""Stations within the storage area, in pockets.

A pocket is a tile beside an aisle, in place of a storage location. The pockets are spread evenly
over the blocks, and the stations of each kind evenly over the pockets. Robots enter a pocket from
the tile of the aisle (or ring road) beside it and return to that tile. A pocket leads nowhere else,
so no robot drives through it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.generator.compass import Direction, Tile
from rmfs.layout.generator.extent import BLOCK_DEPTH, blocks, extent, lanes
from rmfs.layout.generator.tiles import Kind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.parameters import LayoutParameters


GOLDEN = 0.618033988749895
"""Step along a circle of length 1 whose multiples cover the circle evenly."""


@dataclass(frozen=True, slots=True)
class Pocket:
    """One station within the storage area.

    Attributes
    ----------
    kind
        Kind of station.
    tile, aisle
        Tile of the station, and the neighbouring tile in the aisle or ring road.
    """

    kind: str
    tile: Tile
    aisle: Tile


def pockets(parameters: LayoutParameters, kinds: NDArray[np.int8]) -> list[Pocket]:
    """Return the stations within the storage area of a tier.

    If more such stations are wanted than there are blocks, the list is empty.

    Parameters
    ----------
    kinds
        Kind of each tile, shape (rows, columns).
    """
    wanted = [
        name for name, group in parameters.other_stations.items() for _ in range(group.within)
    ]
    total = blocks(parameters)
    if not wanted or len(wanted) > total:
        return []
    chosen = _spread(len(wanted), total)
    return [
        _pocket(parameters, kinds, kind, block)
        for kind, block in zip(_in_turn(wanted), chosen, strict=True)
    ]


def _spread(count: int, total: int) -> list[int]:
    """Choose blocks evenly, with an irrational step so that no line of blocks is preferred."""
    chosen: list[int] = []
    place = 0.5
    while len(chosen) < count:
        block = int(place % 1.0 * total)
        while block in chosen:
            block = (block + 1) % total
        chosen.append(block)
        place += GOLDEN
    return sorted(chosen)


def _in_turn(wanted: list[str]) -> list[str]:
    """Order the stations so that those of each kind are spread among the others."""
    seen: dict[str, int] = {}
    ranked = []
    for kind in wanted:
        seen[kind] = seen.get(kind, 0) + 1
        ranked.append(((seen[kind] - 0.5) / wanted.count(kind), kind))
    return [kind for _, kind in sorted(ranked)]


def _pocket(parameters: LayoutParameters, kinds: NDArray[np.int8], kind: str, block: int) -> Pocket:
    """Take the middle of the northern row of a block; the aisle, or ring road, is north of it."""
    size, across = extent(parameters), parameters.vertical_aisles + 1
    row, column = divmod(block, across)
    tile = (
        size.top + 1 + row * (BLOCK_DEPTH + lanes(parameters)),
        size.left
        + 1
        + column * (parameters.block_length + lanes(parameters))
        + parameters.block_length // 2,
    )
    assert kinds[tile] == Kind.STORAGE
    return Pocket(kind, tile, Direction.NORTH.step(tile))
