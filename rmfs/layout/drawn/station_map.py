"""Grid maps from path-finding benchmarks, with stations and storage locations added."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.config import apply_overrides, read_toml, validate
from rmfs.errors import InputError
from rmfs.layout.drawn.assembly import assembled
from rmfs.layout.drawn.drawing import Drawing, Ground, Stand, neighbours
from rmfs.layout.drawn.parameters import MapStations
from rmfs.layout.drawn.queues import straight_queue
from rmfs.layout.mapf import BLOCKED, read_rows
from rmfs.layout.problems import stop_if_any

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from rmfs.layout.drawn.drawing import Cell
    from rmfs.layout.model import Layout


def stations_file(path: Path) -> Path:
    """Return the file with the stations of a map: NAME.map.toml beside NAME.map."""
    return path.with_name(f"{path.name}.toml")


def read_station_map(path: Path, overrides: Sequence[tuple[list[str], Any]] = ()) -> Layout:
    """Read a `.map` file, and the stations and storage locations in the file beside it.

    Parameters
    ----------
    overrides
        Pairs of a key, as a list of its parts, and a value, which replaces the value in the file of
        stations.

    Raises
    ------
    InputError
        If one of the two files cannot be read or is wrong; the message names up to 10 wrong cells.
    """
    beside = stations_file(path)
    given = validate(MapStations, apply_overrides(read_toml(beside), list(overrides)), str(beside))
    drawing = _floor(read_rows(path), given.storage)
    stations = {"pick": given.pick_stations, "replenishment": given.replenishment_stations}
    stop_if_any(list(_wrong(drawing, stations)), beside)
    places = [(kind, _cells(queue)) for kind, queues in stations.items() for queue in queues]
    for cell in (cell for _, queue in places for cell in queue):
        drawing.ground[cell] = Ground.QUEUE
    for kind, queue in places:
        length = given.queue_length
        whole = queue if len(queue) > 1 else straight_queue(drawing, queue[0], length)
        drawing.stands.append(Stand("pick" if kind == "pick" else "replenishment", whole))
    try:
        return assembled(drawing, given, path.stem)
    except InputError as error:
        raise InputError(f"{beside}: {error}") from None


def _floor(rows: list[str], storage: str) -> Drawing:
    """Return the aisles and storage locations of a map.

    Shelves without an adjacent aisle become obstacles.
    """
    signs = np.array([list(row) for row in rows])
    shelf = np.isin(signs, list(storage))
    free = ~shelf & ~np.isin(signs, list(BLOCKED))
    ground = np.where(free, Ground.AISLE, Ground.NOTHING).astype(np.int8)
    drawing = Drawing(ground.copy())
    for row, column in np.argwhere(shelf).tolist():
        if any(drawing.at(cell) == Ground.AISLE for cell in neighbours((row, column))):
            ground[row, column] = Ground.STORAGE
    return Drawing(ground)


def _wrong(drawing: Drawing, stations: dict[str, list[list[list[int]]]]) -> Iterator[str]:
    """Yield station cells that are not aisles, are given twice, or do not form a chain."""
    seen: set[Cell] = set()
    for kind, queues in stations.items():
        for number, queue in enumerate(queues):
            key = f"{kind}_stations.{number}"
            cells = _cells(queue)
            for rank, cell in enumerate(cells):
                told = f"{key}: [{cell[0]}, {cell[1]}]"
                if drawing.at(cell) != Ground.AISLE:
                    rows, columns = drawing.ground.shape
                    yield f"{told} is not a free cell of the {rows} rows and {columns} columns"
                if cell in seen:
                    yield f"{told} is given twice"
                if rank and cell not in neighbours(cells[rank - 1]):
                    yield f"{told} is not adjacent to the previous cell"
                seen.add(cell)


def _cells(queue: list[list[int]]) -> tuple[Cell, ...]:
    return tuple((row, column) for row, column in queue)
