"""A floor of cells: their types, and where a robot can drive from each."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

Cell = tuple[int, int]
"""A cell: its row from the top and its column from the left, both counted from 0."""

NEIGHBOURS: tuple[Cell, ...] = ((0, 1), (-1, 0), (0, -1), (1, 0))
"""Steps to the east, north, west and south."""


class Ground(IntEnum):
    """Type of a cell."""

    NOTHING = 0
    AISLE = 1
    STORAGE = 2
    QUEUE = 3
    """A place of a queue, or the station at its head."""


@dataclass(frozen=True, slots=True)
class Stand:
    """A station and its queue, from the station to the entrance."""

    kind: Literal["pick", "replenishment"]
    queue: tuple[Cell, ...]


@dataclass
class Drawing:
    """A floor of H rows and W columns.

    Attributes
    ----------
    ground
        Type of each cell (`Ground`), shape (H, W).
    one_way
        For each one-way aisle cell, the only step (one of `NEIGHBOURS`) to another aisle cell.
    full, empty
        Storage locations drawn with a pod, and those drawn without a pod. Of the storage locations
        in neither list, the share `Equipment.pod_share` holds a pod.
    robots
        Cells drawn with a robot.
    stands
        The stations.
    """

    ground: NDArray[np.int8]
    one_way: dict[Cell, Cell] = field(default_factory=dict)
    full: list[Cell] = field(default_factory=list)
    empty: list[Cell] = field(default_factory=list)
    robots: list[Cell] = field(default_factory=list)
    stands: list[Stand] = field(default_factory=list)

    def at(self, cell: Cell) -> Ground:
        """Return the type of a cell; `NOTHING` beyond the edge."""
        row, column = cell
        rows, columns = self.ground.shape
        inside = 0 <= row < rows and 0 <= column < columns
        return Ground(self.ground[row, column]) if inside else Ground.NOTHING

    def steps(self) -> Iterator[tuple[Cell, Cell]]:
        """Yield pairs of cells such that a robot can drive from the first to the second.

        A place of a queue leads to the place ahead, and a station to the aisles beside it. The
        entrance of a queue can be reached from aisles only. Storage locations lead to all
        neighbours except queues, since robots without a pod drive beneath pods. A one-way cell
        leads to another aisle cell only in its direction; the cell ahead does not lead back to it.
        """
        places = {cell: (stand, rank) for stand in self.stands for rank, cell in
                  enumerate(stand.queue)}  # fmt: skip
        rows, columns = self.ground.shape
        for tail in ((row, column) for row in range(rows) for column in range(columns)):
            if tail in places and places[tail][1] > 0:
                stand, rank = places[tail]
                yield tail, stand.queue[rank - 1]
            elif self.at(tail) != Ground.NOTHING:
                for step in NEIGHBOURS:
                    head = (tail[0] + step[0], tail[1] + step[1])
                    if self._leads(tail, step, head, places):
                        yield tail, head

    def _leads(
        self, tail: Cell, step: Cell, head: Cell, places: dict[Cell, tuple[Stand, int]]
    ) -> bool:
        if self.at(head) == Ground.NOTHING:
            return False
        if self.at(head) == Ground.AISLE and self.one_way.get(tail, step) != step:
            return False
        if self.one_way.get(head) == (-step[0], -step[1]):
            return False
        if tail in places:
            return self.at(head) == Ground.AISLE
        if head in places:
            stand, rank = places[head]
            return self.at(tail) == Ground.AISLE and rank == len(stand.queue) - 1
        return True


def neighbours(cell: Cell) -> list[Cell]:
    """Return the four cells beside a cell: east, north, west, south."""
    return [(cell[0] + row, cell[1] + column) for row, column in NEIGHBOURS]
