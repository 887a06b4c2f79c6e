"""Robots and trips from the files of path-finding benchmarks.

Each line of a `.scen` file (MovingAI) holds the start and the only goal of one robot. In the
format of the League of Robot Runners, an `.agents` file holds the starts of the robots, and a
`.tasks` file holds goals or chains of goals. All goals of a `.tasks` file form one list in the
order of the file; a robot that has reached its goal gets the next goal in the list.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.layout.mapf import read_cells, read_map, waypoint_at
from rmfs.trips.streams import PointTrips, TripStream, random_trips

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rmfs.layout.model import Layout


def scenario(
    map_file: Path, scen: Path, robots: int | None = None
) -> tuple[Layout, Callable[[], TripStream]]:
    """Read a map and the robots of a `.scen` file.

    The first `robots` robots are read; by default, all.

    Returns
    -------
    The layout, and a function that creates its stream of trips: one trip per robot.

    Raises
    ------
    InputError
        If a file is invalid or has fewer robots than requested.
    """
    number = read_cells(map_file)
    width = number.shape[1]
    lines = _lines(scen)
    rows = [line.split() for line in (lines[1:] if lines[:1] and "version" in lines[0] else lines)]
    count = len(rows) if robots is None else robots
    if len(rows) < count:
        raise InputError(f"{scen}: has {len(rows)} robots, not {count}")
    try:
        cells = [[int(word) for word in row[4:8]] for row in rows[:count]]
        pairs = [(y * width + x, gy * width + gx) for x, y, gx, gy in cells]
        outside = next((x for row in cells for x in row[::2] if not 0 <= x < width), None)
    except ValueError:
        raise InputError(
            f"{scen}: expected nine columns a line: bucket, map, its width and "
            "height, start x and y, goal x and y, length"
        ) from None
    if outside is not None:
        raise InputError(f"{scen}: x {outside} is outside the map, which has {width} columns")
    layout = read_map(map_file, [start for start, _ in pairs])
    goals = [waypoint_at(number, goal, str(scen)) for _, goal in pairs]
    return layout, lambda: PointTrips([[goal] for goal in goals])


def league(
    map_file: Path, agents: Path, tasks: Path | None, robots: int | None = None, seed: int = 0
) -> tuple[Layout, Callable[[], TripStream]]:
    """Read a map, the robots of an `.agents` file and the goals of a `.tasks` file.

    The first `robots` robots are read; by default, all.

    Parameters
    ----------
    tasks
        The `.tasks` file. None: an endless stream of random goals.

    Returns
    -------
    The layout, and a function that creates its stream of trips.

    Raises
    ------
    InputError
        If a file is invalid or has fewer robots than requested.
    """
    number = read_cells(map_file)
    starts = [cells[0] for cells in _numbered(agents)]
    count = len(starts) if robots is None else robots
    if len(starts) < count:
        raise InputError(f"{agents}: has {len(starts)} robots, not {count}")
    layout = read_map(map_file, starts[:count])
    if tasks is None:
        return layout, lambda: random_trips(layout, seed)
    goals = [waypoint_at(number, cell, str(tasks)) for chain in _numbered(tasks) for cell in chain]
    return layout, lambda: PointTrips([[] for _ in range(count)], shared=goals)


def _numbered(path: Path) -> list[list[int]]:
    """Read a file with a list of cells, or of chains of cells; its first line is their number."""
    try:
        rows = [[int(cell) for cell in line.replace(",", " ").split()] for line in _lines(path)]
        if not all(rows):
            raise ValueError("a line does not hold a number")
    except ValueError:
        raise InputError(f"{path}: expected whole numbers, the number of lines first") from None
    if not rows or rows[0] != [len(rows) - 1]:
        raise InputError(f"{path}: must begin with the number of lines that follow")
    return rows[1:]


def _lines(path: Path) -> list[str]:
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    return [line for line in lines if line.strip() and not line.startswith("#")]
