"""Contents of the orders of a scenario, for all kinds of demand (`demand.mode`)."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.scenario.orders import OrderSource
from rmfs.scenario.parameters import BacklogDemand, LetterSkus, WordOrders
from rmfs.scenario.skus.letters import read_alphabet
from rmfs.scenario.words import WordSource

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from rmfs.scenario.intake.state import State
    from rmfs.scenario.orders import OrderContent
    from rmfs.scenario.parameters import Scenario
    from rmfs.scenario.skus import SkuSet

    Contents = Callable[[int, State], OrderContent | None]

# numbers below the stream of contents: orders that are counted apart do not shift the others
REGULAR: tuple[int, ...] = ()
BATCHES = (1,)
INITIAL = (2,)
DUE_TIMES = (3,)

_UNLIMITED = 2**62


def contents(scenario: Scenario, skus: SkuSet, seed: int, path: tuple[int, ...]) -> Contents:
    """Return the function that draws the contents of the k-th order.

    With a constant backlog, the contents depend on the stock, unless the orders are words
    (`WordOrders`). In all other cases, the contents do not depend on what happens in a run.

    Parameters
    ----------
    path
        Numbers that select a branch of the random stream (see `Substreams`); orders that are
        numbered separately, such as those of batches, have a branch of their own.

    Raises
    ------
    InputError
        If a file of words is invalid, or an order may have more lines than there are SKUs. Unless
        the demand is a constant backlog, only SKUs with a popularity above zero are counted.
    """
    if isinstance(scenario.orders, WordOrders):
        assert isinstance(scenario.skus, LetterSkus)
        words = WordSource(scenario.orders, read_alphabet(scenario.skus), seed, path)
        return partial(_words, words)
    source = OrderSource(scenario.orders, skus, seed, scenario.name, path)
    if isinstance(scenario.demand, BacklogDemand):
        return partial(_in_stock, source)
    ordered = int(np.count_nonzero(skus.popularity))
    if ordered < scenario.orders.lines.max:
        raise InputError(
            f"{scenario.name}: orders: lines.max = {scenario.orders.lines.max} exceeds the "
            f"{ordered} SKUs with a popularity above zero"
        )
    unlimited = np.full(len(skus), _UNLIMITED)
    return partial(_whatever_stock, source, unlimited)


def _words(words: WordSource, ordinal: int, _state: State) -> OrderContent | None:
    return words.draw(ordinal)


def _in_stock(source: OrderSource, ordinal: int, state: State) -> OrderContent | None:
    return source.draw(ordinal, state.uncommitted)


def _whatever_stock(
    source: OrderSource, unlimited: NDArray[np.int64], ordinal: int, _state: State
) -> OrderContent | None:
    return source.draw(ordinal, unlimited)
