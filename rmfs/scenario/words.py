"""Orders that spell words; each SKU is a letter in a certain colour."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rmfs.random import Stream
from rmfs.scenario.categorical import Categorical
from rmfs.scenario.due import class_of
from rmfs.scenario.orders import OrderContent
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from rmfs.scenario.parameters import WordOrders
    from rmfs.scenario.skus.letters import Alphabet


class WordSource:
    """Draws orders that spell words; all words are equally likely.

    The colour and the number of units of each letter are drawn, too. Equal letters of the same
    colour form one line. An order depends only on the configuration, the seed, `path` and the
    number of the order; it does not depend on the stock.

    Parameters
    ----------
    config
        The table `orders` of a scenario.
    alphabet
        The words and colours of the scenario's table `skus`.
    seed
        The run's seed.
    path
        Numbers that select a branch of the random stream (see `Substreams`). Orders that are
        numbered separately, such as those that arrive in batches, need a separate branch.
    """

    def __init__(
        self, config: WordOrders, alphabet: Alphabet, seed: int, path: tuple[int, ...] = ()
    ) -> None:
        self._alphabet = alphabet
        self._colour = Categorical(list(alphabet.colours.values())).pick
        self._units = config.units_per_letter.sampler()
        self._due, self._class_of = config.due.sampler(), partial(class_of, config.due)
        self._substreams = Substreams(seed, Stream.ORDER_CONTENTS, path)

    def draw(self, ordinal: int) -> OrderContent:
        """Return order number `ordinal`, 0 or greater; equal ordinals give equal orders."""
        uniform = self._substreams.at(ordinal)
        words = self._alphabet.words
        word = words[int(uniform() * len(words))]
        due_offset_s = self._due(urgency := uniform())
        lines: dict[int, int] = {}
        for letter in word:
            sku = self._alphabet.sku(letter, self._colour(uniform()))
            lines[sku] = lines.get(sku, 0) + self._units(uniform())
        units, priority = tuple(lines.values()), self._class_of(urgency)
        return OrderContent(tuple(lines), units, due_offset_s, 0, priority)
