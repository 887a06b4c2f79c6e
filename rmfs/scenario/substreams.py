"""Random numbers for the k-th thing of a stream, whatever came before it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.random import Stream


class Substreams:
    """One stream of the seed's tree, cut into numbered substreams.

    A counter-based generator (Philox) computes its numbers from a key and a counter: the key comes
    from the seed and the stream, the ordinal is a part of the counter. Going to a substream then
    costs one microsecond, where a new generator per ordinal costs ten. Substreams do not overlap
    before 2**64 blocks of four numbers.

    Parameters
    ----------
    seed
        The run's seed, 0 or greater.
    stream
        Which stream of the tree.
    path
        Further numbers below the stream: each has substreams of its own.
    """

    def __init__(self, seed: int, stream: Stream, path: tuple[int, ...] = ()) -> None:
        sequence = np.random.SeedSequence(seed, spawn_key=(int(stream), *path))
        self._generator = np.random.Philox(key=sequence.generate_state(2, np.uint64))
        self._uniform: Callable[[], float] = np.random.Generator(self._generator).random
        self._start = self._generator.state
        self._counter = self._start["state"]["counter"]

    def at(self, ordinal: int) -> Callable[[], float]:
        """Return a function that yields the uniform numbers in [0, 1) of one substream, in order.

        It serves until the next call of `at`: there is one generator, which moves.
        """
        self._counter[1] = ordinal
        self._generator.state = self._start
        return self._uniform
