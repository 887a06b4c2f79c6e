"""File layouts of public data sets: how their rows become orders."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rmfs.errors import InputError
from rmfs.scenario.datasets.orders import NOT_TAKEN
from rmfs.scenario.datasets.rows import MOST_UNITS, rows

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from rmfs.scenario.datasets.orders import Orders

HOUR_S, DAY_S = 3600.0, 86400.0
AMERICAN = "%m/%d/%Y %H:%M"


class Layout(NamedTuple):
    """The file layout of a data set.

    Attributes
    ----------
    files
        Names of the files of the data set; each must be given, in this order.
    source
        Source of the data set.
    read
        Function that reads the files.
    """

    files: tuple[str, ...]
    source: str
    read: Callable[[Sequence[Path], Orders], None]


def instacart(paths: Sequence[Path], orders: Orders) -> None:
    """Read orders of which only weekday and hour are known; all are assigned to one week.

    Orders of the same weekday and hour are spread evenly over this hour. Each line has one unit.
    """
    whole = ("order_id", "order_dow", "order_hour_of_day")
    hours: dict[tuple[int, int], list[str]] = defaultdict(list)
    seen: set[str] = set()
    for row in rows(paths[0], whole):
        name = row.name("order_id")
        if name in seen:
            raise row.wrong("order_id", "occurs twice")
        seen.add(name)
        hours[row.whole("order_dow", 0, 6), row.whole("order_hour_of_day", 0, 23)].append(name)
    for (day, hour), names in sorted(hours.items()):
        for number, name in enumerate(names):
            within = (number + 0.5) / len(names)
            orders.begin(name, round(day * DAY_S + (hour + within) * HOUR_S, 3))
    for path in paths[1:]:
        for row in rows(path, ("order_id", "product_id")):
            order = orders.by_name.get(row.name("order_id"))
            sku = row.name("product_id")
            if order is None:
                orders.left_out[NOT_TAKEN] += 1
            elif sku in order.units:
                raise row.wrong("product_id", "occurs twice in its order")
            else:
                order.add(sku, 1)


def online_retail(paths: Sequence[Path], orders: Orders) -> None:
    """Read invoices; cancelled invoices, returns, and lines not for products are omitted."""
    columns = ("InvoiceNo|Invoice", "StockCode", "Quantity", "InvoiceDate")
    for path in paths:
        # descriptions are in an encoding of their own; what is read is plain
        for row in rows(path, columns, "latin-1"):
            name, sku = row.name("InvoiceNo"), row.name("StockCode")
            units = row.whole("Quantity", -MOST_UNITS)
            moment = row.moment("InvoiceDate", AMERICAN)
            if not name.isdecimal():
                orders.left_out["lines of cancelled or corrected invoices"] += 1
            elif not sku[:5].isdecimal() or len(sku) < 5:
                orders.left_out["lines that are not products (postage, fees)"] += 1
            elif units < 1:
                orders.left_out["lines that are returns"] += 1
            else:
                order = orders.begin(name, moment)
                if order is None:
                    orders.left_out[NOT_TAKEN] += 1
                else:
                    order.add(sku, units)


def jd(paths: Sequence[Path], orders: Orders) -> None:
    """Read order lines, including gifts, which are picked as well."""
    columns = ("order_ID", "sku_ID", "order_time", "quantity")
    for path in paths:
        for row in rows(path, columns):
            name, sku = row.name("order_ID"), row.name("sku_ID")
            units, moment = row.whole("quantity", 1), row.moment("order_time")
            order = orders.begin(name, moment)
            if order is None:
                orders.left_out[NOT_TAKEN] += 1
            else:
                order.add(sku, units)


def olist(paths: Sequence[Path], orders: Orders) -> None:
    """Read orders and their items; cancelled and unavailable orders are omitted.

    Every item is one unit. An order is due at the earliest `shipping_limit_date` of its items; such
    dates are ignored if they are before the order's time of purchase.
    """
    columns = ("order_id", "order_status", "order_purchase_timestamp")
    for row in rows(paths[0], columns):
        name, moment = row.name("order_id"), row.moment("order_purchase_timestamp")
        if name in orders.by_name:
            raise row.wrong("order_id", "occurs twice")
        if row.text("order_status") in ("canceled", "unavailable"):
            orders.by_name[name] = None
            orders.left_out["orders cancelled or not available"] += 1
        else:
            orders.begin(name, moment)
    for row in rows(paths[1], ("order_id", "product_id", "shipping_limit_date")):
        name, sku = row.name("order_id"), row.name("product_id")
        limit = row.moment("shipping_limit_date")
        if name not in orders.by_name:
            raise InputError(
                f"{paths[1]}: line {row.line}: order_id {name:.40} is not in {paths[0]}"
            )
        order = orders.by_name[name]
        if order is None:
            orders.left_out[NOT_TAKEN] += 1
            continue
        order.add(sku, 1)
        if limit >= order.time:  # type: ignore[operator]
            order.due = limit if order.due is None else min(order.due, limit)


LAYOUTS = {
    "instacart": Layout(
        ("orders.csv", "order_products__prior.csv"),
        "The Instacart Online Grocery Shopping Dataset 2017",
        instacart,
    ),
    "online-retail": Layout(
        ("data.csv",), "Online Retail and Online Retail II, UCI Machine Learning Repository",
        online_retail,
    ),
    "jd": Layout(
        ("JD_order_data.csv",),
        "Shen, Tang, Wu, Yuan and Zhou: JD.com, the 2020 MSOM data driven research challenge",
        jd,
    ),
    "olist": Layout(
        ("olist_orders_dataset.csv", "olist_order_items_dataset.csv"),
        "Brazilian E-Commerce Public Dataset by Olist",
        olist,
    ),
}  # fmt: skip
"""The layouts by name."""
