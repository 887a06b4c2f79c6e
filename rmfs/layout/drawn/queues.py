"""Queues of stations: as drawn, or straight by default."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout.drawn.drawing import NEIGHBOURS, Drawing, Ground, neighbours

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.layout.drawn.drawing import Cell

PLACE = "q"
NUMBERS = "123456789"


class ForkError(ValueError):
    """Several cells could be the next place of a queue.

    The error stores the cell of the last known place, and the number of the next place.
    """

    def __init__(self, cell: Cell, rank: int) -> None:
        self.cell, self.rank = cell, rank
        super().__init__(f"{cell}: {rank}")


def drawn_queue(head: Cell, sign: Callable[[Cell], str], taken: set[Cell]) -> tuple[Cell, ...]:
    """Return the cells of a drawn queue, from the station to the entrance.

    The next place is the neighbour with the next number or, if there is none, the only neighbour
    with the sign `q`. If there is no such neighbour either, the queue ends.

    Parameters
    ----------
    sign
        Function that returns the sign drawn at a cell.
    taken
        Cells of all stations and of the queues already read; the cells of this queue are added.

    Raises
    ------
    ForkError
        If several neighbours could be the next place.
    """
    places = [head]
    while True:
        near = [cell for cell in neighbours(places[-1]) if cell not in taken]
        rank = str(len(places))
        numbered = [cell for cell in near if rank in NUMBERS and sign(cell) == rank]
        found = numbered or [cell for cell in near if sign(cell) == PLACE]
        if not found:
            return tuple(places)
        if len(found) > 1:
            raise ForkError(places[-1], len(places))
        places += found
        taken.update(found)


def straight_queue(drawing: Drawing, head: Cell, length: int) -> tuple[Cell, ...]:
    """Lay a straight queue over aisle cells, and mark them as places of a queue.

    The direction with room for the most places is chosen; ties go to the first of east, north, west
    and south. One-way cells, cells beside storage locations and cells with robots are not used. If
    the station has only one adjacent aisle cell, no queue is laid, since robots need this cell to
    leave the station.

    Parameters
    ----------
    head
        Cell of the station.
    length
        Number of places, not counting the station; the queue is shorter if there is not enough
        room.

    Returns
    -------
    The cells from the station to the entrance, including both.
    """
    taken = set(drawing.robots)

    def free(cell: Cell) -> bool:
        if drawing.at(cell) != Ground.AISLE or cell in drawing.one_way or cell in taken:
            return False
        return all(drawing.at(beside) != Ground.STORAGE for beside in neighbours(cell))

    def way(step: Cell) -> list[Cell]:
        places: list[Cell] = []
        while len(places) < length:
            last = places[-1] if places else head
            ahead = (last[0] + step[0], last[1] + step[1])
            if not free(ahead):
                break
            places.append(ahead)
        return places

    exits = sum(drawing.at(cell) == Ground.AISLE for cell in neighbours(head))
    ways = [way(step) for step in NEIGHBOURS] if exits > 1 else []
    places = max(ways, key=len, default=[])
    for cell in places:
        drawing.ground[cell] = Ground.QUEUE
    return (head, *places)
