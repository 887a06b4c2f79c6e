"""The generator of default layouts (RAWSim-O paper, section 3.1.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout.generator.assembly import Assembly
from rmfs.layout.generator.extent import extent
from rmfs.room import ROBOT_BYTES, TILE_BYTES, require

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.layout.model import Layout
    from rmfs.layout.parameters import LayoutParameters


def generate(parameters: LayoutParameters, folder: Path | None = None) -> Layout:
    """Generate the layout that the parameters describe.

    Storage blocks, each two storage locations deep, are separated by horizontal and vertical
    aisles. A ring road surrounds all blocks. On each side with stations or elevators, there is a
    hall outside the ring road, and beyond it a buffer zone that contains their queues. Equal
    parameters give equal layouts.

    Parameters
    ----------
    folder
        Folder that is searched, before the working directory, for Python files that define kinds of
        station. Default: only the working directory.

    Raises
    ------
    InputError
        If a kind of station does not exist or one of its parameters is wrong, or if the layout does
        not fit into memory.
    """
    size = extent(parameters)
    tiles = size.rows * size.columns * parameters.tiers
    robots = parameters.robots * parameters.tiers
    needed = tiles * TILE_BYTES + robots * ROBOT_BYTES
    require(needed, f"layout {parameters.name}: {tiles} tiles, {robots} robots")
    return Assembly(parameters, folder).layout()
