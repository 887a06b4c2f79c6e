"""Fit of affinity, that is, of how often the same SKUs are ordered together.

The generator gives SKUs random partners. The SKU of each line after the first is drawn, with a
certain probability, from the partners of the preceding line's SKU, and otherwise by popularity.
This probability is the share of affinity. To fit it, orders are simulated with several shares.
Interpolation then yields the share for which the lift of the simulated orders equals that of the
file. The lift states how often pairs of SKUs in neighbouring lines recur, relative to chance (see
`lift`).
"""

from __future__ import annotations

from dataclasses import replace
from math import inf, isfinite, log
from typing import TYPE_CHECKING

import numpy as np
from scipy import stats

from rmfs.scenario import exact
from rmfs.scenario.parameters import GeneratedAffinity, GeneratedSkus
from rmfs.scenario.skus import draw_sku_set
from rmfs.scenario.twin.estimates import LEVEL, Estimate

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from rmfs.scenario.skus import SkuSet

    Drawn = Callable[[float, int], SkuSet]
    """Function that creates SKUs from a share of affinity and a seed."""

LEAST_PAIRS = 200
GROUPS = 20
"""Number of groups of orders that are left out in turn (jackknife)."""
SHARES = (0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9)
DRAWS = 4
"""Number of sets of SKUs drawn for each simulated share of affinity."""
MOST_ORDERS = 20_000
TRIES = 16
"""Maximum number of draws of a line to find a SKU that its order does not contain yet."""


def lift(first: NDArray[np.int64], second: NDArray[np.int64], skus: int) -> float:
    """Return how often pairs of SKUs recur, divided by how often they would recur by chance.

    Recurrence is measured by the probability that two of the pairs, chosen at random, are equal.
    For recurrence by chance, the two SKUs of each pair are assumed to be different, but otherwise
    drawn independently. The result is nan if there are fewer than `LEAST_PAIRS` pairs or no pair
    recurs.

    Parameters
    ----------
    first, second
        The two SKUs of each pair of neighbouring lines, shape (m,) each.
    skus
        Number of SKUs.
    """
    number = len(first)
    if number < LEAST_PAIRS:
        return float("nan")
    pairs = np.minimum(first, second) * skus + np.maximum(first, second)
    again = np.unique(pairs, return_counts=True)[1].astype(np.float64)
    same = (again * (again - 1)).sum() / (number * (number - 1.0))
    ends = np.bincount(np.concatenate([first, second]), minlength=skus).astype(np.float64)
    total = 2.0 * number
    square = (ends * (ends - 1)).sum() / (total * (total - 1))
    fourth = (ends * (ends - 1) * (ends - 2) * (ends - 3)).sum()
    fourth /= total * (total - 1) * (total - 2) * (total - 3)
    by_chance = 2 * (square**2 - fourth) / (1 - square) ** 2
    return float(same / by_chance) if same > 0 and by_chance > 0 else float("nan")


def neighbours(
    sku: NDArray[np.int64], first_line: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the pairs of neighbouring lines: the first SKU, the second SKU and the order's index.

    Both lines of a pair belong to the same order. Each of the three arrays has one element per
    pair.
    """
    order = np.repeat(np.arange(len(first_line) - 1), np.diff(first_line))
    here = np.flatnonzero(order[1:] == order[:-1])
    return sku[here], sku[here + 1], order[here]


def fit_affinity(
    sku: NDArray[np.int64], first_line: NDArray[np.int64], skus: Drawn, seed: int
) -> Estimate | None:
    """Fit the share of affinity (see `Affinity`).

    The result is None if there are too few pairs of neighbouring lines, or too few pairs recur.

    Parameters
    ----------
    sku, first_line
        SKU of each line, and index of the first line of each order, as in `OrderStream`.
    skus
        Function that creates the SKUs of the twin from a share of affinity and a seed.
    seed
        Seed of the simulations.
    """
    first, second, order = neighbours(sku, first_line)
    number = int(sku.max()) + 1
    told = lift(first, second, number)
    if not isfinite(told):
        return None
    group = order % GROUPS
    without = np.array([lift(first[group != g], second[group != g], number) for g in range(GROUPS)])
    if not np.isfinite(without).all():
        return None
    scatter = (GROUPS - 1) / GROUPS * ((np.log(without) - np.log(without).mean()) ** 2).sum()
    lines = np.diff(first_line)[:MOST_ORDERS]
    curve, spread = _curve(lines, skus, seed)
    wide = stats.norm.ppf(0.5 + LEVEL / 2) * float(np.sqrt(scatter + spread**2))
    low, value, high = (float(np.interp(log(told) + by, curve, SHARES)) for by in (-wide, 0, wide))
    return Estimate("affinity share", value, low, high)


def _curve(lines: NDArray[np.int64], skus: Drawn, seed: int) -> tuple[NDArray[np.float64], float]:
    """Return the log lift at each of `SHARES`, and its standard deviation over sets of SKUs."""
    logs = np.empty((len(SHARES), DRAWS))
    for draw in range(DRAWS):
        for place, share in enumerate(SHARES):
            rng = np.random.default_rng((seed, draw))
            told = simulated_lift(lines, skus(share, seed + draw), rng)
            logs[place, draw] = log(told) if isfinite(told) else -inf
    known = np.where(np.isfinite(logs), logs, 0.0)
    spread = float(np.sqrt(known.var(axis=1, ddof=1).mean()))
    return np.maximum.accumulate(known.mean(axis=1)), spread


def drawn_skus(skus: GeneratedSkus, weights: NDArray[np.float64] | None) -> Drawn:
    """Return a function that creates SKUs from a share of affinity and a seed.

    Parameters
    ----------
    weights
        Popularity of each SKU, shape (K,); if None, popularities are drawn as `skus` specifies.
    """

    def draw(share: float, seed: int) -> SkuSet:
        made = draw_sku_set(with_affinity(skus, share), seed)
        if weights is None:
            return made
        return replace(made, popularity=exact.significant(weights))

    return draw


def with_affinity(skus: GeneratedSkus, share: float) -> GeneratedSkus:
    """Return `skus` with affinity: random pairs of SKUs that are ordered together.

    With probability `share`, a line after the first is drawn by affinity, that is, from the SKUs
    that form a pair with the SKU of the line before. On average, a SKU belongs to two pairs.
    """
    pairs = min(skus.count, skus.count * (skus.count - 1) // 2)
    given = GeneratedAffinity(share=round(share, 6), pairs=pairs, default_weight=0.0)
    return skus.model_copy(update={"affinity": given})


def simulated_lift(lines: NDArray[np.int64], skus: SkuSet, rng: np.random.Generator) -> float:
    """Return the `lift` of simulated orders with given numbers of lines; nan if undefined.

    Parameters
    ----------
    lines
        Number of lines of each order, shape (n,).
    skus
        The SKUs, with affinity.
    rng
        Random generator with which the orders are drawn.
    """
    draw = _Lines(skus, rng)
    lines = lines[lines > 1]
    if not len(lines):
        return float("nan")
    orders = np.full((len(lines), int(lines.max())), -1)
    orders[:, 0] = draw.popular(len(lines))
    pairs: list[NDArray[np.int64]] = []
    for line in range(1, orders.shape[1]):
        goes_on = np.flatnonzero(lines > line)
        draw.next_line(orders, goes_on, line)
        there = goes_on[orders[goes_on, line] >= 0]
        pairs.append(orders[there, line - 1 : line + 1])
    first, second = np.concatenate(pairs).T
    known = (first >= 0) & (second >= 0)
    return lift(first[known], second[known], len(skus))


class _Lines:
    """Draws lines of many orders at once."""

    def __init__(self, drawn: SkuSet, rng: np.random.Generator) -> None:
        assert drawn.affinity is not None
        order = np.argsort(drawn.affinity.first, kind="stable")
        self._rng, self._share = rng, drawn.affinity.share
        self._popular = np.cumsum(drawn.popularity / drawn.popularity.sum())
        self._partner = drawn.affinity.second[order]
        self._begins = np.searchsorted(drawn.affinity.first[order], np.arange(len(drawn) + 1))
        self._heaped = np.concatenate([[0.0], np.cumsum(drawn.affinity.weight[order])])

    def popular(self, number: int) -> NDArray[np.int64]:
        """Draw SKUs by popularity."""
        at = np.searchsorted(self._popular, self._rng.random(number), side="right")
        return np.minimum(at, len(self._popular) - 1)

    def next_line(self, orders: NDArray[np.int64], which: NDArray[np.int64], line: int) -> None:
        """Draw the next line of some orders: a SKU that they do not have; -1 if none is found."""
        before = orders[which, line - 1]
        begin, end = self._begins[before], self._begins[before + 1]
        follows = (self._rng.random(len(which)) < self._share) & (begin < end) & (before >= 0)
        open_ = np.arange(len(which))
        for turn in range(TRIES):
            if turn == TRIES // 2:
                follows = np.zeros_like(follows)  # as the generator, where all that go are there
            drawn = np.where(follows[open_], self._related(begin, end, open_), 0)
            alone = ~follows[open_]
            drawn[alone] = self.popular(int(alone.sum()))
            fresh = (orders[which[open_], :line] != drawn[:, None]).all(axis=1)
            orders[which[open_[fresh]], line] = drawn[fresh]
            open_ = open_[~fresh]

    def _related(
        self, begin: NDArray[np.int64], end: NDArray[np.int64], which: NDArray[np.int64]
    ) -> NDArray[np.int64]:
        low, high = self._heaped[begin[which]], self._heaped[end[which]]
        at = np.searchsorted(
            self._heaped, low + self._rng.random(len(which)) * (high - low), side="right"
        )
        last = np.maximum(end[which] - 1, 0)
        found: NDArray[np.int64] = self._partner[np.minimum(at - 1, last)]
        return found
