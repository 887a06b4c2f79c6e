"""Orders from the time before the run, for rules that learn from past orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.scenario import OrderSource
from rmfs.scenario.parameters import LetterSkus, WordOrders
from rmfs.scenario.skus.letters import read_alphabet
from rmfs.scenario.words import WordSource

if TYPE_CHECKING:
    from rmfs.scenario import OrderContent, Scenario, SkuSet

PAST_ORDERS = 5000
"""Number of past orders that are drawn."""

_PAST = (1000,)  # below the stream of contents: far from the numbers of orders in the run
_PLENTY = 2**40


def past_orders(scenario: Scenario, skus: SkuSet, seed: int) -> list[OrderContent]:
    """Draw `PAST_ORDERS` orders as the scenario specifies, with unlimited stock of every SKU.

    Parameters
    ----------
    seed
        The run's seed. Past orders have random substreams of their own, so that drawing them does
        not change the orders of the run.
    """
    contents: list[OrderContent | None]
    if isinstance(scenario.orders, WordOrders):
        assert isinstance(scenario.skus, LetterSkus)
        words = WordSource(scenario.orders, read_alphabet(scenario.skus), seed, _PAST)
        contents = [words.draw(ordinal) for ordinal in range(PAST_ORDERS)]
    else:
        source = OrderSource(scenario.orders, skus, seed, scenario.name, _PAST)
        stock = np.full(len(skus), _PLENTY)
        contents = [source.draw(ordinal, stock) for ordinal in range(PAST_ORDERS)]
    return [content for content in contents if content is not None]


class PastOrders:
    """Callable that draws orders from the time before the run; see `past_orders`."""

    def __init__(self, scenario: Scenario, skus: SkuSet, seed: int) -> None:
        self._scenario, self._skus, self._seed = scenario, skus, seed

    def __call__(self) -> list[OrderContent]:
        """Draw the orders from before the run; see `past_orders`."""
        return past_orders(self._scenario, self._skus, self._seed)
