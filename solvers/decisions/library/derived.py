"""Questions that no controller asks, derived from other questions and from sites."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.solvers.decisions.files import Decision
from rmfs.solvers.decisions.library.sites import SITES
from rmfs.solvers.decisions.models import plain_data

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

ORDERS = {"small": 8, "medium": 16, "real": 32, "double": 64}
"""Maximum number of orders of a sequencing question, by size of the site."""

SLOTS = {"small": 3, "medium": 6, "real": 6, "double": 6}
"""Maximum number of orders open at the same time in a sequencing question, by size of the site."""

ROBOTS = {
    "small": (2, 3, 4, 5, 6, 7, 8, 9, 10, 12),
    "medium": (4, 8, 12, 16, 20, 24, 28, 32, 40, 48),
    "real": (15, 20, 24, 26, 30, 35, 45, 60),
    "double": (40, 60, 90, 120),
}
"""Numbers of robots by size of the site: one `run_bound` question for each, over one hour."""


def derived(family: str, size: str, asked: Iterable[Decision]) -> Iterator[Decision]:
    """Derive questions of a family.

    - `rack_allocation`: the orders, free slots and available pods of a pile-on question; a station
      without a free slot is treated as if it had one.
    - `sequencing`: one station, the first orders of a pile-on question, and the available pods that
      hold any of these orders' SKUs.
    - `run_bound`: the site of the given size; one question for each number of robots in `ROBOTS`.

    Orders that the available pods cannot fill are left out.

    Parameters
    ----------
    family
        Name of one of these three families.
    size
        As for `drawing.draw`.
    asked
        Pile-on questions drawn at that size; not used for `run_bound`.
    """
    if family == "run_bound":
        yield from _run_bounds(size)
        return
    for one in asked:
        data = _rack_allocation(one) if family == "rack_allocation" else _sequencing(one, size)
        provenance = {**one.provenance, "made_of": one.name}
        yield Decision(family, data, provenance)


def _tables(one: Decision) -> tuple[np.ndarray, np.ndarray]:
    """Return the units of orders that can be served, and the stock of available pods, by SKU."""
    data = one.data
    units = np.zeros((one.sizes["O"], one.sizes["K"]), np.int64)
    np.add.at(units, (data["line_order"], data["line_sku"]), data["line_units"])
    stock = data["stock"][data["available"].astype(bool)]
    served = (units <= stock.sum(axis=0)).all(axis=1)
    units = units[served]
    wanted = units.any(axis=0)
    return units[:, wanted], stock[:, wanted]


def _rack_allocation(one: Decision) -> dict[str, np.ndarray]:
    units, stock = _tables(one)
    stock = stock[stock.any(axis=1)]
    return {"units": units, "stock": stock, "slots": np.maximum(one.data["slots"], 1)}


def _sequencing(one: Decision, size: str) -> dict[str, object]:
    units, stock = _tables(one)
    needs = (units > 0)[: ORDERS[size]]
    wanted = needs.any(axis=0)
    needs, holds = needs[:, wanted], (stock > 0)[:, wanted]
    holds = np.unique(holds[holds.any(axis=1)], axis=0)
    opened = np.zeros(len(needs), np.int64)
    return {
        "needs": needs.astype(np.int64),
        "holds": holds.astype(np.int64),
        "capacity": SLOTS[size],
        "opened": opened,
    }


def _run_bounds(size: str) -> Iterator[Decision]:
    from rmfs.scenario import sku_set
    from rmfs.simulation.inputs import as_overrides, load_inputs
    from rmfs.solvers.run_bound import run_bound
    from rmfs.traffic import Traffic

    site = SITES[size]
    for robots in ROBOTS[size]:
        changes = {**site.set, "layout.robots": robots}
        inputs = load_inputs(
            site.layout, site.scenarios["backlog"], "default", as_overrides(changes)
        )
        layout = inputs.layout
        skus = sku_set(inputs.scenario.skus)
        data = run_bound(layout, skus, Traffic(layout), 3600.0)
        assert data is not None
        told = {"size": size, "load": "backlog", "moment": "any", "seed": 0}
        provenance = {"layout": site.layout, "set": [f"layout.robots={robots}"], "drawn": told}
        yield Decision("run_bound", plain_data("run_bound", data), provenance)
