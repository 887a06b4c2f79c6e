"""What must be in stock so that the orders of a file can be served."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.scenario.clock import first_us
from rmfs.scenario.sources import order_stream

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Scenario
    from rmfs.scenario.skus import SkuSet


def bundles_to_cover(scenario: Scenario, skus: SkuSet) -> list[int]:
    """Return the SKUs of the bundles that a scenario wants in stock for its file of orders.

    Of each SKU as many whole bundles as hold `stock.order_cover` times the units that are ordered
    until the run ends. The largest bundles come first: the small ones fit into what they leave.

    Raises
    ------
    InputError
        If the file is broken.
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
