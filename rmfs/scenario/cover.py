"""Initial stock needed to serve the orders of a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.scenario.clock import first_us
from rmfs.scenario.sources import order_stream

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Scenario
    from rmfs.scenario.skus import SkuSet


def bundles_to_cover(scenario: Scenario, skus: SkuSet) -> list[int]:
    """Return the SKU of each bundle that the initial stock must contain for a file of orders.

    The bundles of a SKU together contain at least `stock.order_cover` times the units of this SKU
    that are ordered in the scenario's file up to the end of the run. The largest
    bundles come first, because small ones fit into the remaining space. The list is empty if
    `stock.order_cover` is 0.

    Raises
    ------
    InputError
        If the file is invalid.
    """
    cover = scenario.stock.order_cover
    if not cover:
        return []
    stream = order_stream(scenario, skus)
    end_us = first_us(scenario.warmup_s + scenario.duration_s)
    orders = int(np.searchsorted(stream.time_us, end_us, side="right"))
    lines = int(stream.first_line[orders])
    units = np.bincount(stream.sku[:lines], stream.units[:lines], minlength=len(skus))
    bundles = np.ceil(units * cover / skus.bundle_units).astype(np.int64)
    largest_first = np.argsort(-skus.bundle_space, kind="stable")
    return np.repeat(largest_first, bundles[largest_first]).tolist()
