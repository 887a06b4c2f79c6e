"""Converts files of a public data set to a file of orders."""

from __future__ import annotations

import csv
from datetime import datetime
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.errors import InputError
from rmfs.files import replacing
from rmfs.scenario.datasets.layouts import LAYOUTS
from rmfs.scenario.datasets.orders import Order, Orders

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

MOST_LINES = 4_999_999
"""Maximum number of lines of a file of orders that can be read back."""


class Converted(NamedTuple):
    """Result of a conversion.

    Attributes
    ----------
    orders, lines, units, skus
        Numbers of converted orders, lines, units and SKUs.
    first, last
        Times of the first and the last order, in ISO 8601, or in s if the data set has no dates.
    left_out
        Number of omitted orders or lines, by reason (a text).
    """

    orders: int
    lines: int
    units: int
    skus: int
    first: str
    last: str
    left_out: dict[str, int]


def convert(
    layout: str,
    paths: Sequence[Path],
    out: Path,
    *,
    begin: datetime | None = None,
    end: datetime | None = None,
    share: float = 1.0,
    seed: int = 0,
) -> Converted:
    """Convert the files of a public data set to a file of orders.

    Parameters
    ----------
    layout
        A key of `LAYOUTS`, such as "jd".
    paths
        The files of the data set, in the order of `Layout.files`. Further files with the same
        columns as the last one may follow, if the data set is split; layout "olist" ignores them.
    out
        The .csv file to write.
    begin, end
        Only orders from `begin` on and before `end` are used. Default: all orders.
    share
        Probability that such an order is used.
    seed
        Seed of the random choice of orders.

    Raises
    ------
    InputError
        If the layout is unknown; a file is missing, cannot be read, lacks a column or contains an
        invalid field; `out` does not end in .csv or cannot be written; `begin` or `end` is given
        for a layout without dates; no orders remain; or more than `MOST_LINES` order lines remain.
    """
    if layout not in LAYOUTS:
        raise InputError(f"layout {layout!r:.40} is unknown; valid: {', '.join(LAYOUTS)}")
    files = LAYOUTS[layout].files
    if len(paths) < len(files):
        raise InputError(f"layout {layout} needs {len(files)} files: {', '.join(files)}")
    if out.suffix.lower() != ".csv":
        raise InputError(f"{out}: must end in .csv")
    if layout == "instacart" and (begin or end):
        raise InputError(
            "--from, --to: cannot be used with layout instacart, which has no dates: all orders "
            "arrive within one week"
        )
    rng = np.random.default_rng(seed)
    orders = Orders(partial(_takes, begin, end, share, rng))
    LAYOUTS[layout].read(paths, orders)
    taken = orders.taken()
    if not taken:
        raise InputError(f"{paths[0]}: no orders remain{_reasons(orders)}")
    lines = sum(len(order.units) for _, order in taken)
    if lines > MOST_LINES:
        raise InputError(
            f"{paths[0]}: gives {lines} order lines, but a file may have at most {MOST_LINES}; "
            "use --share, or fewer days (--from, --to)"
        )
    _write(taken, out)
    units = sum(sum(order.units.values()) for _, order in taken)
    skus = len({sku for _, order in taken for sku in order.units})
    span = _time(taken[0][1].time), _time(taken[-1][1].time)
    left_out = {what: number for what, number in orders.left_out.items() if number}
    return Converted(len(taken), lines, units, skus, *span, left_out)


def _takes(
    begin: datetime | None,
    end: datetime | None,
    share: float,
    rng: np.random.Generator,
    time: datetime | float,
) -> bool:
    if isinstance(time, datetime):
        if begin is not None and time < begin:
            return False
        if end is not None and time >= end:
            return False
    return share >= 1.0 or float(rng.random()) < share


def _reasons(orders: Orders) -> str:
    told = [f"{number} {what}" for what, number in orders.left_out.items() if number]
    return f" (left out: {', '.join(told)})" if told else ""


def _write(taken: Sequence[tuple[str, Order]], out: Path) -> None:
    with replacing(out) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("time", "order", "sku", "quantity", "due"))
        for name, order in taken:
            due = "" if order.due is None else _time(order.due)
            time = _time(order.time)
            writer.writerows((time, name, sku, n, due) for sku, n in order.units.items())


def _time(time: datetime | float) -> str:
    return time.isoformat() if isinstance(time, datetime) else f"{time:.3f}"
