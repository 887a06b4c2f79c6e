"""The buffer of a station or elevator: parallel segments that form a serpentine.

As in RAWSim-O's default layout, a buffer has `entry_exit_distance + 1` segments of `buffer_width`
tiles, perpendicular to the edge of the hall. The first segment begins at the entrance, and the last
one ends at the exit. The station is on the last segment, on the tile farthest from the hall.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from rmfs.layout.generator.compass import Direction, Tile
from rmfs.layout.generator.extent import extent

if TYPE_CHECKING:
    from rmfs.layout.generator.sites import Site
    from rmfs.layout.parameters import LayoutParameters

Step = tuple[Tile, Tile]


@dataclass(frozen=True, slots=True)
class Buffer:
    """The buffer (queue zone) of one site, that is, of a station or elevator.

    Attributes
    ----------
    queue
        Tiles from the station back to the entrance of the first segment.
    tiles
        All tiles of the buffer: the queue, and the way out from the station to the exit.
    entrances
        Edges that lead from the hall into the buffer: one each into the first, third, fifth ...
        segment.
    steps
        All directed edges that begin inside the buffer.
    """

    site: Site
    queue: tuple[Tile, ...]
    tiles: tuple[Tile, ...]
    entrances: tuple[Step, ...]
    steps: tuple[Step, ...]


def buffer(parameters: LayoutParameters, site: Site) -> Buffer:
    """Return the buffer of a site (a station or elevator)."""
    segments = _segments(parameters, site)
    inward = site.side.opposite
    path = [
        tile
        for index, segment in enumerate(segments)
        for tile in (segment if index % 2 == 0 else reversed(segment))
    ]
    station = path.index(segments[-1][-1])
    way_out = (path[-1], inward.step(path[-1]))
    short_cuts = [
        (segments[index][-1], segments[index + 1][-1]) for index in range(1, len(segments) - 1, 2)
    ]
    return Buffer(
        site=site,
        queue=tuple(reversed(path[: station + 1])),
        tiles=tuple(path),
        entrances=tuple((inward.step(segment[0]), segment[0]) for segment in segments[::2]),
        steps=(*pairwise(path), way_out, *short_cuts),
    )


def _segments(parameters: LayoutParameters, site: Site) -> list[list[Tile]]:
    """Return the segments from the entrance to the exit, each from the hall outward."""
    size = extent(parameters)
    edge: dict[Direction, Tile] = {
        Direction.NORTH: (size.top, size.left),
        Direction.WEST: (size.top, size.left),
        Direction.EAST: (size.top, size.left + size.width - 1),
        Direction.SOUTH: (size.top + size.height - 1, size.left),
    }
    along = Direction.SOUTH if site.side in (Direction.EAST, Direction.WEST) else Direction.EAST
    back = -1 if site.entrance > site.exit else 1
    return [
        [
            site.side.step(along.step(edge[site.side], position), parameters.hall_width + depth)
            for depth in range(1, parameters.buffer_width + 1)
        ]
        for position in range(site.entrance, site.exit + back, back)
    ]
