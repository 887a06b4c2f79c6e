"""Contents of orders that the current stock can serve."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.errors import InputError
from rmfs.random import Stream
from rmfs.scenario.due import NO_CLASS, class_of
from rmfs.scenario.parameters import Orders, not_above_skus
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from rmfs.scenario.categorical import Categorical
    from rmfs.scenario.skus import SkuSet

DRAWS_PER_LINE = 32
"""Number of draws for a line after which the draw is limited to the SKUs that qualify."""


class OrderContent(NamedTuple):
    """The content of an order.

    Attributes
    ----------
    skus, units
        SKU and number of units of each line; all SKUs are different.
    due_offset_s
        Time from arrival to due time, in s; with `DepartureDue`, the minimum of this time.
    redraws
        Number of draws of a SKU that were rejected because earlier orders left too few units of it;
        at most `DRAWS_PER_LINE` for each line.
    priority
        Index of the order's class; -1 unless `orders.due.mode = "classes"`.
    """

    skus: tuple[int, ...]
    units: tuple[int, ...]
    due_offset_s: float
    redraws: int
    priority: int = NO_CLASS


class OrderSource:
    """Draws orders of SKUs that are in stock.

    Order k is drawn from substream (seed, k), so it depends only on the seed, its number k and the
    stock: two runs with the same seed get the same orders until their stock differs. If
    earlier orders leave too few units of the SKU drawn for a line, the SKU is redrawn with the next
    number of the substream; this is equivalent to a draw among the SKUs with enough units left.
    The numbers for the first draws of all lines precede those for redraws, so that a shortage in
    one line does not change the numbers for the first draws of the others.

    Parameters
    ----------
    config
        The table `orders` of a scenario.
    skus
        The SKUs.
    seed
        The run's seed.
    source
        Name of the scenario, for messages.
    path
        Numbers that select a branch of the random stream (see `Substreams`); orders that are
        numbered separately, such as those of batches, have a branch of their own.

    Raises
    ------
    InputError
        If an order may have more lines than there are SKUs.
    """

    def __init__(
        self,
        config: Orders,
        skus: SkuSet,
        seed: int,
        source: str = "orders",
        path: tuple[int, ...] = (),
    ) -> None:
        try:
            not_above_skus(config.lines.max, len(skus))
        except ValueError as error:
            raise InputError(f"{source}: orders: {error}") from None
        self._substreams = Substreams(seed, Stream.ORDER_CONTENTS, path)
        self._lines = config.lines.sampler()
        self._units = config.units_per_line.sampler()
        self._due, self._class_of = config.due.sampler(), partial(class_of, config.due)
        self._by_popularity = skus.by_popularity
        self._affinity_share = 0.0 if skus.affinity is None else skus.affinity.share
        self._by_affinity = None if skus.affinity is None else skus.affinity.samplers(len(skus))

    def draw(self, ordinal: int, uncommitted: NDArray[np.int64]) -> OrderContent | None:
        """Draw order number `ordinal`, given the stock.

        Parameters
        ----------
        ordinal
            Number k of the order, 0 or greater. Each number is used only once: if the result is
            None, the next attempt uses k + 1.
        uncommitted
            Stored units of each SKU minus those that earlier orders still need, shape (K,).

        Returns
        -------
        OrderContent or None
            None if there is a line for which no SKU has enough uncommitted units.
        """
        uniform = self._substreams.at(ordinal)
        lines = self._lines(uniform())
        due_offset_s = self._due(urgency := uniform())
        units = [self._units(uniform()) for _ in range(lines)]
        first = [uniform() for _ in range(lines)]
        related = self._related(lines, uniform)
        stored = uncommitted.item
        chosen: list[int] = []
        redraws = 0
        for line in range(lines):
            sampler = self._sampler(related[line], chosen)
            number, wanted = first[line], units[line]
            for _ in range(DRAWS_PER_LINE):
                sku = sampler.pick(number)
                if sku not in chosen:
                    if stored(sku) >= wanted:
                        break
                    redraws += 1
                number = uniform()
            else:
                enough = uncommitted >= wanted
                enough[chosen] = False
                found = sampler.pick_among(enough, number)
                if found is None and related[line]:
                    found = self._by_popularity.pick_among(enough, number)
                if found is None:
                    return None
                sku = found
            chosen.append(sku)
        priority = self._class_of(urgency)
        return OrderContent(tuple(chosen), tuple(units), due_offset_s, redraws, priority)

    def _related(self, lines: int, uniform: Callable[[], float]) -> list[bool]:
        """Return which lines are drawn by affinity to the previous line."""
        if not self._affinity_share:
            return [False] * lines
        return [False, *(uniform() < self._affinity_share for _ in range(lines - 1))]

    def _sampler(self, related: bool, chosen: list[int]) -> Categorical:
        if not related or self._by_affinity is None:
            return self._by_popularity
        return self._by_affinity(chosen[-1]) or self._by_popularity
