"""Writes streams of orders or bundles to files, and computes their digests (hashes).

Every stream has one canonical text: the content of the CSV file that this module writes for it,
with times in seconds to six decimal places. The digest of the stream is the SHA-256 of this text.
It does not depend on the format of the file from which the stream was read.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.errors import InputError
from rmfs.files import replacing
from rmfs.scenario.clock import US_PER_S
from rmfs.scenario.streams.stream import NO_DUE_US, BundleStream, OrderStream

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams.recorder import StreamRecorder

ORDER_COLUMNS = ("time", "order", "sku", "quantity", "due")
BUNDLE_COLUMNS = ("time", "order", "sku", "quantity")

Stream = OrderStream | BundleStream


def write_stream(stream: Stream, skus: SkuSet, path: Path) -> str:
    """Write a stream and return its digest.

    Parameters
    ----------
    skus
        The SKUs of the stream. Their ids are written to the file; a SKU whose id is the name of a
        SKU, and would be read as such, is written by its name.
    path
        The file, with the suffix .csv or .parquet.

    Raises
    ------
    InputError
        If `path` has another suffix, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in (".csv", ".parquet"):
        raise InputError(f"{path}: must end in .csv or .parquet")
    with replacing(path) as temporary:
        if suffix == ".csv":
            with temporary.open("w", encoding="utf-8", newline="") as file:
                file.writelines(_text(stream, skus))
        else:
            from rmfs.scenario.streams.parquet_file import write_parquet  # slow to import

            write_parquet(_columns(stream, skus), temporary)
    return digest(stream, skus)


def write_streams(recorded: StreamRecorder, skus: SkuSet, folder: Path) -> dict[str, str]:
    """Write the arrivals of a run to `orders.csv` and `bundles.csv`; return their digests.

    The keys of the result are `orders` and `bundles`.

    Raises
    ------
    InputError
        If the files cannot be written.
    """
    orders, bundles = recorded.orders.build(), recorded.bundles.build()
    return {
        "orders": write_stream(orders, skus, folder / "orders.csv"),
        "bundles": write_stream(bundles, skus, folder / "bundles.csv"),
    }


def digest(stream: Stream, skus: SkuSet) -> str:
    """Return the SHA-256 of a stream's canonical text."""
    hashed = hashlib.sha256()
    for line in _text(stream, skus):
        hashed.update(line.encode())
    return hashed.hexdigest()


def _text(stream: Stream, skus: SkuSet) -> Iterator[str]:
    ids = [_quoted(told) for told in _told(skus)[stream.sku].tolist()]
    units = stream.units.tolist()
    times = [_seconds(time_us) for time_us in stream.time_us.tolist()]
    if isinstance(stream, BundleStream):
        yield f"{','.join(BUNDLE_COLUMNS)}\n"
        for order, row in enumerate(zip(times, ids, units, strict=True)):
            time, sku, quantity = row
            yield f"{time},{order},{sku},{quantity}\n"
        return
    classes = _classes(stream)
    more = () if classes is None else ("priority",)
    yield f"{','.join((*ORDER_COLUMNS, *more))}\n"
    first_line = stream.first_line.tolist()
    for order, (time, due_us) in enumerate(zip(times, stream.due_us.tolist(), strict=True)):
        due = "" if due_us == NO_DUE_US else _seconds(due_us)
        last = due if classes is None else f"{due},{classes[order]}"
        for line in range(first_line[order], first_line[order + 1]):
            yield f"{time},{order},{ids[line]},{units[line]},{last}\n"


def _told(skus: SkuSet) -> NDArray[Any]:
    """Return the id or, if the id is the name of a SKU, the name of each SKU, shape (K,)."""
    names = set(skus.names)
    ids = [str(sku) for sku in skus.ids.tolist()]
    if names.isdisjoint(ids):
        return skus.ids
    told = (name if sku in names else sku for sku, name in zip(ids, skus.names, strict=True))
    return np.array(list(told), dtype=object)


def _quoted(field: int | str) -> int | str:
    """Return a field of a CSV file, in quotation marks if it needs them."""
    if isinstance(field, int) or not set(field) & {",", '"'}:
        return field
    doubled = field.replace('"', '""')
    return f'"{doubled}"'


def _classes(stream: OrderStream) -> list[str] | None:
    """Return the name of the class of each order, empty for an order without a class."""
    if stream.priority is None:
        return None
    return [("", *stream.classes)[1 + number] for number in stream.priority.tolist()]


def _seconds(time_us: int) -> str:
    """Write a time in s with six decimals, exactly."""
    return f"{time_us // US_PER_S}.{time_us % US_PER_S:06d}"


def _columns(stream: Stream, skus: SkuSet) -> dict[str, NDArray[Any]]:
    """Return a stream as columns; `due` is nan for orders without a due time."""
    lines = {"sku": _told(skus)[stream.sku], "quantity": stream.units}
    if isinstance(stream, BundleStream):
        return {"time": stream.time_us / US_PER_S, "order": np.arange(len(stream)), **lines}
    order = np.repeat(np.arange(len(stream)), np.diff(stream.first_line))
    due_us = stream.due_us[order]
    due = np.where(due_us == NO_DUE_US, np.nan, due_us / US_PER_S)
    columns = {"time": stream.time_us[order] / US_PER_S, "order": order, **lines, "due": due}
    classes = _classes(stream)
    if classes is not None:
        columns["priority"] = np.array(classes, dtype=object)[order]
    return columns
