"""Comparison of the orders of a file with those of its twin, the generator fitted to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.scenario.intake.export import order_stream_of
from rmfs.scenario.twin.affinity import lift, neighbours
from rmfs.scenario.twin.arrivals import HOUR_US, fit_arrivals
from rmfs.scenario.twin.estimates import Agreement

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Scenario
    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import OrderStream

MOST_WORK = 1e9
MOST_ORDERS = 50_000
"""Maximum number of simulated orders of the twin; at least one cycle is always simulated."""


def agreements(
    stream: OrderStream,
    scenario: Scenario,
    skus: SkuSet,
    days: int,
    cycle_h: int,
    seed: int,
    *,
    p_popularity: float,
    p_arrivals: float,
) -> list[Agreement]:
    """Return figures for the orders of a file, with the same figures for orders from a scenario.

    Parameters
    ----------
    stream
        The orders of the file.
    scenario
        The scenario, fitted to these orders.
    skus
        SKUs of the scenario.
    days
        Number of days over which the orders of `stream` arrive.
    cycle_h
        Period in h after which the arrival rates repeat.
    seed
        Seed with which the scenario generates the orders.
    p_popularity, p_arrivals
        p values of the goodness-of-fit tests of popularity and arrivals; the result includes them.
    """
    rate_per_day = len(stream) / days
    # a line that follows affinity costs time in proportion to the SKUs
    lines = int(stream.first_line[-1]) / len(stream)
    affordable = MOST_WORK / (len(skus) * lines) if skus.affinity is not None else MOST_ORDERS
    most = max(int(min(MOST_ORDERS, affordable) / rate_per_day), 1)
    cycle_days = cycle_h // 24
    watched = max(min(days, most) // cycle_days, 1) * cycle_days
    # the last order comes before the end, not at it
    lasting = scenario.model_copy(update={"duration_s": watched * 86400.0 - 1e-3, "warmup_s": 0.0})
    made = order_stream_of(lasting, skus, seed)
    data, twin = _figures(stream, days, cycle_h), _figures(made, watched, cycle_h)
    tests = {
        "share of the orders for the most popular tenth": p_popularity,
        "variance / mean of the orders per hour": p_arrivals,
    }
    return [Agreement(name, data[name], twin[name], tests.get(name, np.nan)) for name in data]


def _figures(stream: OrderStream, days: int, cycle_h: int) -> dict[str, float]:
    lines = np.diff(stream.first_line)
    often = np.sort(np.unique(stream.sku[stream.first_line[:-1]], return_counts=True)[1])[::-1]
    tenth = max(len(often) // 10, 1)
    first, second, _ = neighbours(stream.sku, stream.first_line)
    day_us = 24 * HOUR_US
    begin_us = int(stream.time_us[0]) // day_us * day_us
    arrivals = fit_arrivals(stream.time_us - begin_us, days, cycle_h)
    return {
        "orders per h": arrivals.mean.value,
        "variance / mean of the orders per hour": arrivals.dispersion,
        "lines per order, mean": float(lines.mean()),
        "lines per order, sd": float(lines.std()),
        "units per line, mean": float(stream.units.mean()),
        "units per line, sd": float(stream.units.std()),
        "share of the orders for the most popular tenth": float(often[:tenth].sum() / often.sum()),
        "repeated pairs of SKUs, relative to chance": lift(
            first, second, int(stream.sku.max()) + 1
        ),
    }
