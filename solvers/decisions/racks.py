"""Reader for files of Valle and Beasley (2021): racks, products and orders.

A file states its sizes (`N` products, `R` racks, `O` orders, `RS` shelves of a rack), then lists

- below `Racks`, one row per rack: its index, and the product and quantity on each of its shelves;
- below `Orders`, one row per order: its index, its number of units, and the product of each unit.

The format is described by the authors
(homepages.dcc.ufmg.br/~arbex/mobileRacks/rackInstancesDescription.txt); their files are not
included here. The number of pickers and the number of orders per picker are not in the file, and
must be given separately.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.solvers.decisions.files import Decision

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

SIZES = ("N", "R", "O", "RS")
RACKS, ORDERS = "Racks", "Orders"
_LARGEST_MIB = 64
_LARGEST = 100_000


def read_racks(path: Path, pickers: int, orders_each: int) -> Decision:
    """Convert a file to a question of the family `rack_allocation`.

    Parameters
    ----------
    path
        The file.
    pickers
        Number of pickers, at least 1. In rmfs, each picker is a station.
    orders_each
        Number of orders per picker, at least 1.

    Raises
    ------
    InputError
        If the file cannot be read, is not as described, or has fewer than `pickers` times
        `orders_each` orders.
    """
    sizes: dict[str, int] = {}
    tables: dict[str, dict[int, tuple[int, list[int]]]] = {RACKS: {}, ORDERS: {}}
    section = ""
    for number, words in _rows(path):
        where = f"{path}: line {number}"
        if words[0] in tables:
            section = words[0]
        elif not section and words[0] in SIZES:
            sizes[words[0]] = _whole(words[1:2], where, words[0])[0]
        elif section:
            index, *row = _whole(words, where, section)
            tables[section][index] = number, row
        else:
            raise InputError(f"{where}: {words[0]}: must be one of {', '.join(SIZES)}, or {RACKS}")
    missing = [name for name in SIZES if name not in sizes]
    if missing:
        raise InputError(f"{path}: {', '.join(missing)}: is missing")
    stock = _table(path, RACKS, tables[RACKS], sizes["R"], sizes["N"])
    units = _table(path, ORDERS, tables[ORDERS], sizes["O"], sizes["N"])
    if pickers * orders_each > len(units):
        raise InputError(f"{path}: O: {len(units)} orders are fewer than {pickers} x {orders_each}")
    data = {"units": units, "stock": stock, "slots": np.full(pickers, orders_each, np.int64)}
    told = {"instance": path.name, "as_in": "Valle and Beasley 2021", "pickers": pickers}
    return Decision("rack_allocation", data, {**told, "orders_each": orders_each})


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the words of each line that has words, without comments (after #)."""
    try:
        text = read_bounded(path, _LARGEST_MIB).decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{path}: must be text in UTF-8") from None
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split("#")[0].split()
        if words and words[0] != "Index":
            yield number, words


def _whole(words: list[str], where: str, what: str) -> list[int]:
    try:
        found = [int(word) for word in words]
    except ValueError:
        found = []
    if not found or min(found) < 0 or max(found) > _LARGEST:
        raise InputError(f"{where}: {what}: must be whole numbers from 0 to {_LARGEST}")
    return found


def _table(
    path: Path, section: str, rows: dict[int, tuple[int, list[int]]], count: int, products: int
) -> NDArray[np.int64]:
    """Return the number of units per row and product."""
    if sorted(rows) != list(range(count)):
        raise InputError(f"{path}: {section}: must have the rows 0 to {count - 1}, each once")
    found = np.zeros((count, products), np.int64)
    for index, (number, row) in rows.items():
        where = f"{path}: line {number}: {section}"
        if section == ORDERS:
            if not row or len(row) != row[0] + 1:
                raise InputError(f"{where}: the number of products differs from the one stated")
            row = [word for product in row[1:] for word in (product, 1)]
        if len(row) % 2 or max(row[::2], default=0) >= products:
            raise InputError(f"{where}: must have products from 0 to {products - 1}")
        np.add.at(found[index], row[::2], row[1::2])
    return found
