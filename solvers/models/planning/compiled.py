"""Interface to the compiled start rule and search: converts the input and the resulting plan."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.solvers.models.planning.values import Plan
from rmfs.traffic._core import Visits  # the package has one compiled library

if TYPE_CHECKING:
    from rmfs.solvers.models.planning.data import Planning


class Found(NamedTuple):
    """A plan, its value (the negative of the objective), and the work spent.

    The work is the number of stock entries and lines examined.
    """

    plan: Plan
    value: float
    work: int


def visits(data: Planning) -> Visits:
    """Pass an input to the compiled code; return the object that offers the rule and the search.

    SKUs that no line asks for are left out.
    """
    wanted, sku = np.unique(data.line_sku, return_inverse=True)
    stock = data.stock if len(wanted) == data.stock.shape[1] else data.stock[:, wanted]
    return Visits(
        data.under_way,
        data.kept,
        data.order_station.tolist(),
        data.order_until.tolist(),
        data.order_worth.tolist(),
        data.line_order.tolist(),
        sku.tolist(),
        data.line_units.tolist(),
        data.line_worth.tolist(),
        np.ascontiguousarray(stock),
        np.ascontiguousarray(data.cost).ravel(),
        data.visits,
        data.decay,
    )


def found(told: tuple[list[list[int]], list[int], list[int], float, int]) -> Found:
    """Turn the result of the compiled rule or search into a `Found`."""
    pods, order_station, line_visit, value, work = told
    plan = Plan(
        tuple(tuple(new) for new in pods),
        np.array(order_station, np.int64),
        np.array(line_visit, np.int64),
    )
    return Found(plan, value, work)
