"""Layouts from grid maps of path-finding benchmarks (`.map` files; Stern et al. 2019).

Each free cell becomes a waypoint; two-way lanes of one metre connect it to the free cells on its
four sides. Layouts made here have no pods and no stations: robots drive from point to point. As in
the files, cells are numbered row by row from the top left; in the layout, y grows upwards.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.layout.model import Layout, RobotKind, Tier

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

BLOCKED = "@OTW"
"""Characters of cells that cannot be entered; cells with other characters (`.`, `G`, `S`, `E`) are
free."""

MOST_CELLS = 1_200_000
"""Maximum number of cells of a map; the largest published ones have 1024 x 1024."""

LARGEST_MIB = 8
"""Maximum size of a file in MiB, line ends included."""

KIND = RobotKind(0.35, 1.0, 1.0, 1.5, 2.5, 2.2)
"""The robot of the default layout, since these files specify no size or speed."""


def read_map(path: Path, robots: list[int] | None = None) -> Layout:
    """Return the layout that a `.map` file defines.

    Parameters
    ----------
    robots
        Numbers of the cells (row times width plus column) in which the robots start. Default: the
        first free cell of each of the first ten rows that have a free cell.

    Raises
    ------
    InputError
        If the file is not a grid map, or a cell in `robots` is not free or occurs twice.
    """
    free = _free(path)
    number = cell_waypoints(free)
    rows, columns = np.nonzero(free)
    count = len(rows)
    start, target = _edges(number)
    if robots is None:
        first = [int(number[row][free[row]][0]) for row in range(len(free)) if free[row].any()]
        places = np.array(first[:10], np.int32)
    else:
        places = np.array([waypoint_at(number, cell, str(path)) for cell in robots], np.int32)
    if len(set(places.tolist())) < len(places):
        raise InputError(f"{path}: two robots stand on the same cell")
    none = np.zeros(0, np.int32)
    return Layout(
        name=path.stem,
        tiers=(Tier(float(free.shape[1]), float(free.shape[0])),),
        x_m=columns.astype(np.float64) + 0.5,
        y_m=free.shape[0] - rows.astype(np.float64) - 0.5,
        tier=np.zeros(count, np.int16),
        edge_start=start,
        edge_target=target,
        is_storage=np.zeros(count, np.bool_),
        is_queue=np.zeros(count, np.bool_),
        pick_stations=(),
        replenishment_stations=(),
        elevators=(),
        pod_waypoint=none,
        pod_capacity=np.zeros(0),
        pod_radius_m=0.45,
        robot_waypoint=places,
        robot_heading_rad=np.zeros(len(places)),
        robot_kind=np.zeros(len(places), np.int16),
        robot_kinds=(KIND,),
    )


def _edges(number: NDArray[np.int64]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return offsets and heads of the edges between neighbouring free cells."""
    around = np.pad(number, 1, constant_values=-1)
    # above, left, right, below: in the order of their numbers
    sides = (around[:-2, 1:-1], around[1:-1, :-2], around[1:-1, 2:], around[2:, 1:-1])
    beside = np.stack([side[number >= 0] for side in sides], axis=1)
    degree = (beside >= 0).sum(axis=1)
    start = np.concatenate([[0], np.cumsum(degree)]).astype(np.int32)
    return start, beside[beside >= 0].astype(np.int32)


def read_cells(path: Path) -> NDArray[np.int64]:
    """Return the waypoint of each cell of a map, -1 for blocked cells, shape (rows, columns)."""
    return cell_waypoints(_free(path))


def cell_waypoints(free: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the waypoint of each cell, -1 for blocked cells, shape (rows, columns).

    Waypoints are numbered row by row.

    Parameters
    ----------
    free
        Whether each cell is free, shape (rows, columns).
    """
    number = np.full(free.shape, -1, np.int64)
    number[free] = np.arange(free.sum())
    return number


def waypoint_at(number: NDArray[np.int64], cell: int, source: str) -> int:
    """Return the waypoint of a cell.

    Parameters
    ----------
    number
        Waypoint of each cell, -1 for blocked cells, shape (rows, columns).
    cell
        Number of the cell: row times width plus column.
    source
        Name of the file, for error messages.

    Raises
    ------
    InputError
        If the cell does not exist or is blocked.
    """
    if not 0 <= cell < number.size or number.flat[cell] < 0:
        raise InputError(f"{source}: cell {cell} is not a free cell of the map")
    return int(number.flat[cell])


def read_rows(path: Path) -> list[str]:
    """Return the rows of a map file as strings with one character per cell, the top row first.

    Raises
    ------
    InputError
        If the file is not a grid map.
    """
    try:
        lines = read_bounded(path, LARGEST_MIB).decode("utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    head = [line.split() for line in lines[:4]]
    if len(head) < 4 or [words[:1] for words in head] != [["type"], ["height"], ["width"], ["map"]]:
        raise InputError(f"{path}: must start with type, height, width and map, one per line")
    try:
        height, width = int(head[1][1]), int(head[2][1])
    except (IndexError, ValueError):
        raise InputError(f"{path}: height and width must be integers") from None
    if height * width > MOST_CELLS:
        raise InputError(
            f"{path}: height and width: {height * width:,} cells; at most {MOST_CELLS:,} are "
            "allowed"
        )
    rows = [line.rstrip() for line in lines[4:] if line.strip()]
    if len(rows) != height or any(len(row) != width for row in rows):
        raise InputError(f"{path}: expected {height} rows of {width} cells")
    return rows


def _free(path: Path) -> NDArray[np.bool_]:
    rows = read_rows(path)
    signs = np.array(rows).view("U1").reshape(len(rows), -1)
    free = ~np.isin(signs, list(BLOCKED))
    if free.sum() < 2:
        raise InputError(f"{path}: has fewer than two free cells")
    return free
