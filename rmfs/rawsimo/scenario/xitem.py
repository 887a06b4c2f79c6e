"""Reader for RAWSim-O's order lists (.xitem), which also list bundles and SKUs."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.rawsimo.xml import Unknown, read_root
from rmfs.scenario.problems import Problems
from rmfs.scenario.skus.content import SkuFileContent
from rmfs.scenario.streams.rows import BundleRows, OrderRows

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from xml.etree.ElementTree import Element

    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import BundleStream, OrderStream

ROOT = "OrderList"

_ATTRIBUTES = {
    "OrderList": ("Type",),
    "ItemDescription": ("ID", "Type", "Weight", "Letter", "Color"),
    "ItemBundle": ("TimeStamp", "ItemDescription", "Size"),
    "Order": ("TimeStamp",),
    "Position": ("ItemDescriptionID", "Count"),
}
_CHILDREN = {
    "OrderList": ("ItemDescriptions", "ItemBundles", "Orders"),
    "ItemDescriptions": ("ItemDescription",),
    "ItemBundles": ("ItemBundle",),
    "Orders": ("Order",),
    "Order": ("Positions",),
    "Positions": ("Position",),
}

Row = tuple[int, tuple[str, str, str, str, str]]


@dataclass(frozen=True)
class OrderList:
    """The contents of an .xitem file.

    Attributes
    ----------
    path
        The file.
    skus
        Its SKUs; their popularities are in proportion to the units ordered, or equal if there are
        no orders.
    notes
        Remarks on unknown elements and attributes, which were ignored.
    """

    path: Path
    skus: SkuFileContent
    notes: tuple[str, ...]
    _orders: tuple[Row, ...]
    _bundles: tuple[Row, ...]

    def orders(self, skus: SkuSet) -> OrderStream:
        """Return the orders of the list, which have no due times.

        Raises
        ------
        InputError
            If orders are invalid; the message is one line that names the first of them.
        """
        problems = Problems(self.path)
        rows = OrderRows(skus, problems, "order")
        for number, fields in self._orders:
            rows.take(number, fields)
        rows.end()
        problems.stop_if_any()
        return rows.builder.build()

    def bundles(self, skus: SkuSet, largest: float = math.inf) -> BundleStream:
        """Return the bundles of the list.

        Parameters
        ----------
        largest
            Capacity of the largest pod, in space units.

        Raises
        ------
        InputError
            If bundles are invalid; the message is one line that names the first of them.
        """
        problems = Problems(self.path)
        rows = BundleRows(skus, problems, "bundle", largest)
        for number, fields in self._bundles:
            rows.take(number, fields)
        problems.stop_if_any()
        return rows.builder.build()


def read_xitem(path: Path) -> OrderList:
    """Read an order list.

    Raises
    ------
    InputError
        If the file is not an order list, or a SKU is invalid. Orders and bundles are validated
        later, by `OrderList.orders` and `OrderList.bundles`.
    """
    root = read_root(path, ROOT)
    orders = tuple(_order_rows(root))
    ordered: Counter[str] = Counter()
    for _, (_, _, sku, quantity, _) in orders:
        # a longer quantity is refused when the orders are requested
        ordered[sku] += int(quantity) if quantity.isdecimal() and len(quantity) < 19 else 0
    return OrderList(
        path=path,
        skus=_skus(path, root, ordered),
        notes=tuple(_notes(root)),
        _orders=orders,
        _bundles=tuple(_bundle_rows(root)),
    )


def _skus(path: Path, root: Element, ordered: Counter[str]) -> SkuFileContent:
    problems = Problems(path)
    ids: dict[int, float] = {}
    popularity, names = [], []
    for element in root.iterfind("ItemDescriptions/ItemDescription"):
        number = element.get("ID", "")
        space = _positive(element.get("Weight", ""))
        if not number.isdecimal() or len(number) > 15:
            problems.add(f"ItemDescription: ID must be a whole number (given: {number!r:.40})")
        elif int(number) in ids:
            problems.add(f"ItemDescription {number} occurs twice")
        elif space is None:
            problems.add(f"ItemDescription {number}: Weight must be a positive number")
        else:
            ids[int(number)] = space
            popularity.append(ordered[number])
            names.append(_name(element))
    if not ids:
        problems.add("<ItemDescriptions> lists no SKU")
    problems.stop_if_any()
    return SkuFileContent(
        ids=np.array(list(ids), dtype=np.int64),
        popularity=np.array(popularity if any(popularity) else [1] * len(ids), dtype=np.float64),
        space_per_unit=np.array(list(ids.values())),
        names=tuple(names) if all(names) else (),
    )


def _name(element: Element) -> str:
    """Return the letter and colour of an SKU, or nothing."""
    code, colour = element.get("Letter", ""), element.get("Color", "")
    if not code.isdecimal() or len(code) > 8 or int(code) > 0x10FFFF:
        return ""
    return f"{chr(int(code))} {colour.lower()}".strip()


def _positive(text: str) -> float | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return number if 0 < number < math.inf else None


def _order_rows(root: Element) -> Iterator[Row]:
    for number, order in enumerate(root.iterfind("Orders/Order"), 1):
        time = order.get("TimeStamp", "")
        positions = order.findall("Positions/Position")
        if not positions:
            # an order of nothing is a wrong one, not one to leave out
            yield number, (time, str(number), "", "", "")
        for position in positions:
            sku, quantity = position.get("ItemDescriptionID", ""), position.get("Count", "")
            yield number, (time, str(number), sku, quantity, "")


def _bundle_rows(root: Element) -> Iterator[Row]:
    for number, bundle in enumerate(root.iterfind("ItemBundles/ItemBundle"), 1):
        sku, quantity = bundle.get("ItemDescription", ""), bundle.get("Size", "")
        yield number, (bundle.get("TimeStamp", ""), "", sku, quantity, "")


def _notes(root: Element) -> list[str]:
    unknown = Unknown()
    for element in root.iter():
        unknown.attributes(element, _ATTRIBUTES.get(element.tag, ()))
        unknown.children(element, _CHILDREN.get(element.tag, ()))
    return unknown.notes()
