"""Random numbers for the k-th item, such as an order, independent of those of all other items."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.random import Stream


class Substreams:
    """One of the random streams derived from a seed, divided into numbered substreams.

    A counter-based generator (Philox) computes its numbers from a key and a counter. The key is
    derived from the seed, the stream and the path, and the number of the substream is part of the
    counter. Switching to a substream therefore takes about one microsecond; creating a generator
    would take about ten.
    A substream has 2**64 blocks of four numbers before it overlaps with the next.

    Parameters
    ----------
    seed
        The run's seed, 0 or greater.
    stream
        The stream, such as that of the contents of orders.
    path
        Numbers that select a branch of the stream; each branch has its own substreams.
    """

    def __init__(self, seed: int, stream: Stream, path: tuple[int, ...] = ()) -> None:
        sequence = np.random.SeedSequence(seed, spawn_key=(int(stream), *path))
        self._generator = np.random.Philox(key=sequence.generate_state(2, np.uint64))
        self._uniform: Callable[[], float] = np.random.Generator(self._generator).random
        self._start = self._generator.state
        self._counter = self._start["state"]["counter"]

    def at(self, ordinal: int) -> Callable[[], float]:
        """Return a function that returns the next number of a substream, uniform in [0, 1).

        The function must not be used after the next call of `at`, because all substreams share one
        generator.

        Parameters
        ----------
        ordinal
            Number of the substream; its sequence starts again from the first number.
        """
        self._counter[1] = ordinal
        self._generator.state = self._start
        return self._uniform
