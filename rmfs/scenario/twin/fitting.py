"""Fits a scenario to a file of orders."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan
from typing import TYPE_CHECKING

import numpy as np

from rmfs.config import validate
from rmfs.errors import InputError
from rmfs.scenario.counts import ListedCount
from rmfs.scenario.distributions import Gamma
from rmfs.scenario.parameters import GeneratedSkus, Orders, PoissonDemand, Scenario, SkuFile
from rmfs.scenario.parameters.rates import OrderSteps
from rmfs.scenario.sources import sku_set
from rmfs.scenario.streams import read_orders
from rmfs.scenario.twin.affinity import drawn_skus, fit_affinity, with_affinity
from rmfs.scenario.twin.agreement import agreements
from rmfs.scenario.twin.arrivals import HOUR_US, fit_arrivals
from rmfs.scenario.twin.estimates import Agreement, Estimate, shares
from rmfs.scenario.twin.popularity import fit_popularity

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import OrderStream

DAY_H = 24
WEEK_H = 168
MOST_UNSEEN = 20
"""Maximum ratio of the estimated total number of SKUs to the number of SKUs in the file; above it,
gamma weights have no meaning."""
MOST_LISTED = 200
"""Maximum number of lines of an order, or units of a line; larger numbers count as this one."""


@dataclass(frozen=True, slots=True)
class Twin:
    """A generator fitted to orders, with figures that show how well it fits.

    Attributes
    ----------
    scenario
        Scenario that generates orders like those of the file.
    estimates
        Fitted parameters of the generator, with their confidence intervals.
    agreements
        Figures computed both for the orders of the file and for orders of the twin.
    orders
        Number of orders in the file.
    skus
        SKUs of the twin if they have the popularities found in the file (`listed` in `fit_twin`)
        and must therefore be written to a file; None if the scenario generates them from
        distributions.
    """

    scenario: Scenario
    estimates: list[Estimate]
    agreements: list[Agreement]
    orders: int
    skus: SkuSet | None = None


def fit_twin(
    path: Path, name: str, *, weekly: bool = False, listed: bool = False, seed: int = 0
) -> Twin:
    """Fit a generator to a file of orders.

    Parameters
    ----------
    path
        File of orders, as for `demand.file`; the first and the last day count as whole days.
    name
        Name of the scenario.
    weekly
        Whether arrival rates repeat every week instead of every day.
    listed
        Whether the SKUs of the twin have the popularities found in the file; otherwise, their
        popularities are drawn from a gamma distribution fitted to the file.
    seed
        Seed of the twin's SKUs and orders, and of the simulations that estimate the share of
        affinity (see `Affinity`).

    Raises
    ------
    InputError
        If the file is invalid or contains too few orders, if `weekly` is true and the file covers
        fewer than seven days, or if no gamma distribution fits the popularity of its SKUs.
    """
    skus = sku_set(validate(SkuFile, {"file": path}, str(path)))
    stream = read_orders(path, skus)
    try:
        return _fitted(stream, name, seed, weekly=weekly, listed=listed)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _fitted(stream: OrderStream, name: str, seed: int, *, weekly: bool, listed: bool) -> Twin:
    day_us = DAY_H * HOUR_US
    first = int(stream.time_us[0]) // day_us
    days = int(stream.time_us[-1]) // day_us - first + 1
    cycle_h = WEEK_H if weekly else DAY_H
    if days * DAY_H < cycle_h:
        raise InputError(f"--weekly: needs orders of at least 7 days (given: {days})")
    arrivals = fit_arrivals(stream.time_us - first * day_us, days, cycle_h)
    often = np.unique(stream.sku[stream.first_line[:-1]], return_counts=True)[1]
    popularity = None if listed else fit_popularity(often)
    if popularity is not None and popularity.skus.value > MOST_UNSEEN * len(often):
        raise InputError(
            "popularity is too uneven for gamma weights: the fit estimates "
            f"{popularity.skus.value:.0f} SKUs, although only {len(often)} were ordered; use "
            "--listed, which keeps the popularity of each SKU"
        )
    count = len(often) if popularity is None else round(popularity.skus.value)
    lines, units = _listed(np.diff(stream.first_line)), _listed(stream.units)
    if count < lines.max:
        raise InputError(f"an order has {lines.max} lines, but the fit estimates {count} SKUs")
    skus = GeneratedSkus(count=count, seed=seed)
    weights = None
    if popularity is None:
        weights = np.sort(often)[::-1].astype(np.float64)
    else:
        shape = round(popularity.shape.value, 9)
        gamma = Gamma(shape=shape, scale=1 / shape)
        skus = GeneratedSkus(count=count, seed=seed, popularity=gamma)
    draw = drawn_skus(skus, weights)
    share = fit_affinity(stream.sku, stream.first_line, draw, seed)
    if share is not None and share.low > 0:  # or it cannot be told from none
        skus, made = with_affinity(skus, share.value), draw(share.value, seed)
    else:
        made = replace(draw(0.0, seed), affinity=None)
    scenario = Scenario(
        format="rmfs-scenario/1",
        name=name,
        description=f"twin of {len(stream)} orders of {days} days",
        duration_s=cycle_h * 3600.0,
        skus=skus,
        orders=Orders(lines=lines, units_per_line=units),
        demand=PoissonDemand(
            orders_per_h=float(np.mean([one.value for one in arrivals.hours])),
            per_station=False,
            initial_orders=0,
            profile=OrderSteps(
                cycle_s=cycle_h * 3600.0,
                weights=tuple(round(one.value, 9) for one in arrivals.hours),
            ),
        ),
    )
    estimates = [
        *([] if popularity is None else [popularity.skus, popularity.shape]),
        *([] if share is None else [share]),
        arrivals.mean,
        *arrivals.hours,
        *shares("share of orders with lines", np.array(lines.weights).astype(np.int64)),
        *shares("share of lines with units", np.array(units.weights).astype(np.int64)),
    ]
    compared = agreements(
        stream,
        scenario,
        made,
        days,
        cycle_h,
        seed,
        p_popularity=nan if popularity is None else popularity.p,
        p_arrivals=arrivals.p,
    )
    return Twin(scenario, estimates, compared, len(stream), made if listed else None)


def _listed(values: NDArray[np.int64]) -> ListedCount:
    counts = np.bincount(np.minimum(values, MOST_LISTED))[1:]
    return ListedCount(weights=tuple(counts.astype(float).tolist()))
