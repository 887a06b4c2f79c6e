"""Reads layouts drawn as text."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.config import apply_overrides, validate
from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.layout.drawn.assembly import assembled
from rmfs.layout.drawn.drawing import Drawing, Ground, Stand
from rmfs.layout.drawn.parameters import PictureHead
from rmfs.layout.drawn.queues import NUMBERS, PLACE, ForkError, drawn_queue, straight_queue
from rmfs.layout.problems import stop_if_any

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rmfs.layout.drawn.drawing import Cell
    from rmfs.layout.model import Layout

END_OF_HEAD = "---"

MOST_CELLS = 1_000_000

LARGEST_MIB = 4

NOTHING, AISLE, ROBOT = " #@", ".", "r"
DRAWN, FULL, EMPTY = "x", "X", "o"
PICK, REPLENISHMENT = "Pg", "R"
ARROWS: dict[str, Cell] = {">": (0, 1), "^": (-1, 0), "<": (0, -1), "v": (1, 0)}

SIGNS = {
    ".": "two-way aisle",
    "> < ^ v": "one-way aisle; only in this direction can robots drive to another aisle cell",
    "x": "storage location; a share `pod_share` of these locations have a pod at the start",
    "X": "storage location with a pod at the start",
    "o": "storage location without a pod at the start",
    "P or g": "pick station",
    "R": "replenishment station",
    "q": "place of a queue; the places form a chain that ends at the station",
    "1 ... 9": "place of a queue, numbered from the station; needed instead of `q` where queues "
    "lie side by side",
    "r": "aisle with a robot at the start",
    "# or @ or blank": "no waypoint: robots cannot drive there",
}
"""Meanings of the signs of a picture."""

_GROUND = {
    **dict.fromkeys(NOTHING, Ground.NOTHING),
    **dict.fromkeys([AISLE, ROBOT, *ARROWS], Ground.AISLE),
    **dict.fromkeys([DRAWN, FULL, EMPTY], Ground.STORAGE),
    **dict.fromkeys([*PICK, *REPLENISHMENT, PLACE, *NUMBERS], Ground.QUEUE),
}


def read_picture(path: Path, overrides: Sequence[tuple[list[str], Any]] = ()) -> Layout:
    """Read a layout drawn as text.

    The file may begin with a head in TOML (`PictureHead`) that ends with a line `---`. The picture
    follows, with one character, called a sign, for each cell (`SIGNS`).

    Parameters
    ----------
    overrides
        Pairs of a key, as a list of its parts, and a value, which replaces the value in the head.

    Raises
    ------
    InputError
        If the file cannot be read, or the head or the picture is wrong; if a sign is wrong, the
        message names its line and column.
    """
    head, first, lines = _split(path)
    given = validate(PictureHead, apply_overrides(head, list(overrides)), str(path))
    drawing = _Picture(path, first, lines).drawing(given.queue_length)
    try:
        return assembled(drawing, given, path.stem)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _split(path: Path) -> tuple[dict[str, Any], int, list[str]]:
    """Return the head, the line number at which the picture begins, and its lines."""
    try:
        text = read_bounded(path, LARGEST_MIB).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None
    lines = [line.rstrip() for line in text.splitlines()]
    end = lines.index(END_OF_HEAD) + 1 if END_OF_HEAD in lines else 0
    try:
        head = tomllib.loads("\n".join(lines[: max(end - 1, 0)]))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: the head is not valid TOML: {error!s:.200}") from None
    picture = lines[end:]
    while picture and not picture[0]:
        del picture[0]
        end += 1
    while picture and not picture[-1]:
        del picture[-1]
    width = max(map(len, picture), default=0)
    if not picture or width * len(picture) > MOST_CELLS:
        raise InputError(f"{path}: must hold a picture of 1 to {MOST_CELLS} cells")
    return head, end + 1, [line.ljust(width) for line in picture]


class _Picture:
    """The lines of a picture, all of one length.

    Parameters
    ----------
    path
        Path of the file, for messages.
    first
        Number of the picture's first line in the file.
    """

    def __init__(self, path: Path, first: int, lines: list[str]) -> None:
        self._path, self._first, self._lines = path, first, lines
        self._cells = [
            ((row, column), sign)
            for row, line in enumerate(lines)
            for column, sign in enumerate(line)
        ]

    def drawing(self, queue_length: int) -> Drawing:
        """Return the floor that the picture shows."""
        stop_if_any(
            [
                f"{self._where(cell)}: {sign!r} is not a valid sign; valid: {', '.join(SIGNS)}"
                + (f"; a head must end with a line {END_OF_HEAD}" if sign in "=[" else "")
                for cell, sign in self._cells
                if sign not in _GROUND
            ],
            self._path,
        )
        ground = np.array([[_GROUND[sign] for sign in line] for line in self._lines], np.int8)
        drawing = Drawing(
            ground,
            one_way={cell: ARROWS[sign] for cell, sign in self._cells if sign in ARROWS},
            full=self._all(FULL),
            empty=self._all(EMPTY),
            robots=self._all(ROBOT),
        )
        heads = self._all(PICK + REPLENISHMENT)
        taken = set(heads)
        queues = {head: self._queue(head, taken) for head in heads}
        self._no_stray_places(taken)
        for head, queue in queues.items():
            whole = queue if len(queue) > 1 else straight_queue(drawing, head, queue_length)
            picks = self._sign(head) in PICK
            drawing.stands.append(Stand("pick" if picks else "replenishment", whole))
        return drawing

    def _queue(self, head: Cell, taken: set[Cell]) -> tuple[Cell, ...]:
        try:
            return drawn_queue(head, self._sign, taken)
        except ForkError as fork:
            raise InputError(
                f"{self._path}: {self._where(fork.cell)}: the queue of the station at "
                f"{self._where(head)} continues in several directions; number its places 1, 2, ... "
                "from the station"
            ) from None

    def _no_stray_places(self, taken: set[Cell]) -> None:
        stray = [cell for cell in self._all(PLACE + NUMBERS) if cell not in taken]
        stop_if_any(
            [
                f"{self._where(cell)}: {self._sign(cell)!r} belongs to no queue: no path over q, "
                "or over 1, 2, ... in order, leads from it to a station (P, g or R)"
                for cell in stray
            ],
            self._path,
        )

    def _all(self, signs: str) -> list[Cell]:
        return [cell for cell, sign in self._cells if sign in signs]

    def _sign(self, cell: Cell) -> str:
        row, column = cell
        inside = 0 <= row < len(self._lines) and 0 <= column < len(self._lines[0])
        return self._lines[row][column] if inside else " "

    def _where(self, cell: Cell) -> str:
        return f"line {self._first + cell[0]}, column {cell[1] + 1}"
